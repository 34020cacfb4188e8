"""What happens before a first page is there: the server, loading ahead, the first screen."""
