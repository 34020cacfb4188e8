"""What was chosen, brought and kept, and what is known from it: values, not how they are shown."""
