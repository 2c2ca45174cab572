"""The command `isogyre`. Each subcommand has a file in `service.commands`; what it needs is loaded when it runs."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence
from typing import Annotated

import typer

from crystal_core import __version__
from crystal_core.errors import InputError, IsogyreError, NotSupportedError
from minerals_db.errors import MineralDataError
from service.commands.complaint import complain, input_complaints
from service.commands.interface import interface
from service.commands.minerals import minerals
from service.commands.plate import plate
from service.commands.render import render
from service.commands.scene import scene
from service.commands.serve import serve
from service.commands.specimen import specimen
from service.commands.wave_surface import wave_surface

__all__ = ["main", "run"]

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command()(render)
app.command()(interface)
app.command()(plate)
app.command("wave-surface")(wave_surface)
app.add_typer(minerals, name="minerals")
app.add_typer(scene, name="scene")
app.command()(specimen)
app.command()(serve)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"isogyre {__version__}")
        raise typer.Exit


@app.callback()
def isogyre(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Show what light does inside a crystal."""


def main() -> None:
    """Run the command line of this process and exit."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Run one command line.

    Parameters
    ----------
    arguments : sequence of str
        Without the program's name.

    Returns
    -------
    int
        Exit code: 0 done, 1 failed, 2 bad input, 130 interrupted. What went wrong stands on stderr, a line each.
    """
    command = typer.main.get_command(app)
    try:
        code = command.main(args=list(arguments), prog_name="isogyre", standalone_mode=False)
    except typer.TyperException as error:  # a wrong option or argument
        complain(f"{error.format_message().rstrip('.')} (see isogyre --help)")
        return error.exit_code
    except InputError as error:
        for line in input_complaints(error):
            complain(line)
        return BAD_INPUT
    except MineralDataError as error:  # of the user's own folder, as a rule; of a development of the built-in ones
        for fault in error.faults:
            complain(str(fault))
        return BAD_INPUT
    except NotSupportedError as error:
        complain(str(error))
        return BAD_INPUT
    except IsogyreError as error:
        complain(str(error))
        if error.__cause__ is not None and not isinstance(error.__cause__, IsogyreError | OSError):
            traceback.print_exception(error.__cause__)  # a defect of ours; whoever mends it needs to know where
        return FAILED
    except OSError as error:
        complain(f"{error.filename or 'a file'}: {error.strerror or error}")
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED
    return int(code or DONE)
