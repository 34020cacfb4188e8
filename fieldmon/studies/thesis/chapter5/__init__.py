"""The thesis's chapter 5: Dynamic, Naive and Bouncy with prior information, run again."""
