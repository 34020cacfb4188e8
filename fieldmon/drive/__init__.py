"""A day driven, by whatever drives: charged as planned, in a physical simulation, or live."""
