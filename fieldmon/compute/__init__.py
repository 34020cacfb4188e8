"""Arrays, compiled loops and named random streams: nothing of plots or pests."""
