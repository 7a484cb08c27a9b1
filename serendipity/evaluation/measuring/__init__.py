"""The common ground of measurements: figures, tables, plots, jobs and their record, tasks of others."""
