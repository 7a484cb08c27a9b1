"""The game of silent assistance: moves, values, rules of choice, solutions."""
