"""One module a page, each with a `show`; Streamlit takes a folder named pages for itself."""
