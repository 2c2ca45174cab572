"""`isogyre minerals`: find minerals, show one, check the data."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated

import typer

from crystal_core.errors import Fault, InputError
from service.commands.complaint import one_line
from service.commands.output import print_json, print_text

if TYPE_CHECKING:
    from minerals_db.query import Query

__all__ = ["minerals"]

minerals = typer.Typer(add_completion=False, rich_markup_mode=None, help="Find minerals, show one, check the data.")

_FAULTY = 1

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@minerals.command("list")
def list_minerals(
    name: Annotated[
        str | None, typer.Option(help="Part of an English or Russian name, the id, or the group's.", metavar="TEXT")
    ] = None,
    formula: Annotated[str | None, typer.Option(help="Part of the formula, such as CO3.", metavar="TEXT")] = None,
    elements: Annotated[str | None, typer.Option(help="All of these, such as Ca,C.", metavar="SYMBOLS")] = None,
    group: Annotated[str | None, typer.Option(help="The family, such as tourmaline.", metavar="NAME")] = None,
    system: Annotated[str | None, typer.Option(help="Crystal system, such as trigonal.", metavar="SYSTEM")] = None,
    optical_class: Annotated[str | None, typer.Option(metavar="isotropic|uniaxial|biaxial")] = None,
    optic_sign: Annotated[str | None, typer.Option(metavar="positive|negative")] = None,
    n_min: Annotated[str | None, typer.Option(help="A principal index lies from here", metavar="N")] = None,
    n_max: Annotated[str | None, typer.Option(help="to here, at 589.3 nm.", metavar="N")] = None,
    birefringence_min: Annotated[str | None, typer.Option(help="At 589.3 nm.", metavar="DELTA")] = None,
    birefringence_max: Annotated[str | None, typer.Option(metavar="DELTA")] = None,
    colour: Annotated[str | None, typer.Option(help="One it commonly has, such as red.", metavar="COLOUR")] = None,
    pleochroism: Annotated[str | None, typer.Option(help="At least so.", metavar="none|weak|moderate|strong")] = None,
    quality: Annotated[
        str | None,
        typer.Option(
            help="Dispersion: published or fallback; colour: measured, estimated or none; or one of each.",
            metavar="WORD[,WORD]",
        ),
    ] = None,
    kind: Annotated[str | None, typer.Option(metavar="mineral|variety|synthetic|glass")] = None,
    origin: Annotated[str | None, typer.Option(metavar="built-in|own")] = None,
    sort: Annotated[
        str | None,
        typer.Option(
            help="id, name, name-ru, index, birefringence, density, 2v, hardness; backwards with - before it "
            "[default: id].",
            metavar="KEY[,KEY]",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print an array of JSON objects.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print CSV with a header row.")] = False,
) -> None:
    """List the minerals that fulfil every condition; without any, all of them.

    Facts are those at 589.3 nm; * where this wavelength lies outside the range of a curve, whose nearer end stands for
    it. A table on a terminal, aligned text elsewhere. ISOGYRE_MINERALS_DIR names a folder of minerals of your own.
    """
    from minerals_db.query import Query
    from service.minerals.parameters import option, read_parameters

    asked = {key: value for key, value in locals().items() if key in Query.model_fields and value is not None}
    if as_json and as_csv:
        raise InputError.at("--csv", "not together with --json")
    _print_list(read_parameters(Query, asked, option), as_json, as_csv)


def _print_list(query: Query, as_json: bool, as_csv: bool) -> None:
    import minerals_db
    from minerals_db.query import find
    from service.commands.mineral_list import print_list
    from service.minerals.summaries import COLUMNS, summary, summary_rows
    from service.minerals.tables import csv_text

    found = find(minerals_db.minerals(), query)
    if as_json:
        print_json([summary(mineral) for mineral in found])
    elif as_csv:
        print_text(csv_text(COLUMNS, summary_rows(found)), end="")
    else:
        print_list(found)


@minerals.command("show")
def show(
    mineral_id: Annotated[str, typer.Argument(help="Such as calcite.", metavar="ID")],
    wavelengths: Annotated[
        str, typer.Option(help="nm: 400,500,600 or start:stop:step.", metavar="LIST")
    ] = "486.1,589.3,656.3",
    concentrations: Annotated[
        list[str] | None,
        typer.Option(
            "--concentration", help="Weight % of a chromophore; any number of times.", metavar="CHROMOPHORE=PERCENT"
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show all that is known of a mineral, with sources and statuses, and its optics at wavelengths."""
    import minerals_db
    from service.commands.mineral_page import print_page
    from service.minerals.optics import mineral_optics, read_concentrations
    from service.minerals.summaries import entry_document
    from service.minerals.wavelengths import read_wavelengths

    try:
        mineral = minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise InputError.at("ID", f"{error} (see isogyre minerals list)") from None
    texts, faults = _assigned(concentrations or [])
    weight_percent, wrong = read_concentrations(mineral, texts, lambda key: f"--concentration {key}")
    faults += wrong
    try:
        asked = read_wavelengths(wavelengths)
    except ValueError as error:
        faults.append(Fault("--wavelengths", str(error)))
    if faults:
        raise InputError(faults)
    optics = mineral_optics(mineral, asked, weight_percent, "--wavelengths")
    if as_json:
        told = optics.document()
        more = {key: told[key] for key in ("concentrations_weight_percent", "optics")}
        print_json({**entry_document(mineral), **more})
    else:
        print_page(optics)


def _assigned(texts: Iterable[str]) -> tuple[dict[str, str], list[Fault]]:
    found: dict[str, str] = {}
    faults = []
    for text in texts:
        key, equals, value = text.partition("=")
        if not (key and equals):
            faults.append(Fault("--concentration", f"must be CHROMOPHORE=PERCENT, not {text!r}"))
        elif key in found:
            faults.append(Fault(f"--concentration {key}", "is set more than once"))
        found.setdefault(key, value)
    return ({}, faults) if faults else (found, faults)


@minerals.command("check")
def check(
    paths: Annotated[
        list[str] | None,
        typer.Argument(
            help="Folders of data files, or data files [default: the built-in ones and ISOGYRE_MINERALS_DIR].",
            metavar="[FOLDER|FILE]...",
        ),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Check mineral data files; a line for each fault: file: field: reason.

    Exit code 0 if there is nothing wrong, 1 if there is.
    """
    from service.minerals.check import check_all, check_paths

    report = check_paths(paths) if paths else check_all()
    if as_json:
        print_json(report.document())
    else:
        for fault in report.faults:
            print_text(one_line(str(fault)))
        if not report.faults:
            print_text(report.counts())
    return _FAULTY if report.faults else 0


@minerals.command("schema")
def schema() -> None:
    """Print the JSON Schema of a whole entry."""
    import minerals_db

    print_json(minerals_db.entry_schema())
