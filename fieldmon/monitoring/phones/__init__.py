"""Who scouts, with which key, and what their phones send."""
