"""What happens: the states of a plan, epoch by epoch, before anything is drawn."""
