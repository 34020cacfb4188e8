"""Every text of the app, and how names and numbers are written."""
