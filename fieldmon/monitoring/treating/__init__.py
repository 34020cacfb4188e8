"""What is sprayed and brought out: products, plants, and the rules that follow from them."""
