"""Maps whose finds are traced: to where each came from, and to what it may have sent out."""
