"""The `fieldmon` command, one file a command. Heavy imports wait until a command needs them."""
