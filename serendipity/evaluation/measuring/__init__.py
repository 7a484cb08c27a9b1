"""What everything that is measured has in common: figures, tables, jobs and their record, tasks of others."""
