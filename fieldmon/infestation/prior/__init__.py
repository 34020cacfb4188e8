"""What is believed before anything is inspected: from records, edges, paths and rasters."""
