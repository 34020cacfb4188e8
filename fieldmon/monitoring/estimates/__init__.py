"""What a season says of its plot: the chances of each morning, their layers and figures."""
