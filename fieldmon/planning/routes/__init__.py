"""The best route for any reward per plant, and what no other route can exceed."""

from fieldmon.planning.routes.best_route import BestRoute, best, bound

__all__ = ["BestRoute", "best", "bound"]
