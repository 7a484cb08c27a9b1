"""The best policy, by LAO* and, where runs return, policy iteration."""
