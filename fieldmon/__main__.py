"""`python -m fieldmon`: the same as the command `fieldmon`."""

from fieldmon.cli.start import main

if __name__ == "__main__":
    main()
