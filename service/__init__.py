"""The service: HTTP interface, jobs, artifacts, the command line."""
