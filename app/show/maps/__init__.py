"""Map layers of a plot. No Streamlit in here, and nothing that needs the internet."""
