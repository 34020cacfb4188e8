"""What a person reads who stopped a command. Nothing is imported for it."""

#: the sentence, and the exit code
STOPPED = "Stopped; nothing was written that is not complete."
STOPPED_CODE = 130
