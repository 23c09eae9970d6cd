"""One page of a shaft or a train for those who decide: drawing, numbers, verdict, in two languages."""
