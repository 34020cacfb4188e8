"""Is a further robot worth it? Teams of several sizes, against field size and spread.

`seasons` simulates them, `summary` says what each further one saves, and `report` draws it.
"""
