"""The subcommands of `isogyre`, one a file; each loads what is slow to load when it runs."""
