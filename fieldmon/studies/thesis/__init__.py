"""A. Yehoshua's thesis (Ben-Gurion University, 2023), its experiments made again."""
