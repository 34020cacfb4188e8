"""The season's file: its tables, its layers, its styles in QGIS, and what can be wrong with it."""
