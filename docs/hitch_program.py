"""Finds the program `hitch`, for the examples of this folder."""
import os, pathlib, shutil, sys


def find(given=None):
    """The program: `given`, else $HITCH_PROGRAM, else the one on PATH, else the one that cargo built from this clone. Ends the
    script with one line if there is none."""
    named = given or os.environ.get("HITCH_PROGRAM")
    if named:
        return shutil.which(named) or sys.exit(f"{named}: is not a program; give the path of hitch")
    clone = pathlib.Path(__file__).resolve().parent.parent
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", clone / "target"))
    built = [str(target / profile) for profile in ("release", "debug")]
    return shutil.which("hitch") or shutil.which("hitch", path=os.pathsep.join(built)) or sys.exit(
        "hitch is neither on PATH nor built: run `cargo build --release`, or set HITCH_PROGRAM to its path")
