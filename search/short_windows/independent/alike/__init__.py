"""Things that can be exchanged for one another: robots are told by how many of them they have seen to."""
