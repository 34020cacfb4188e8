"""The best route for any reward per plant, with a bound on what any other route could reach."""
