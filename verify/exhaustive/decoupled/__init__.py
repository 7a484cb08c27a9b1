"""What robots can do each on its own while the human follows ``pi_H``."""
