"""Commands followed through the package: modules loaded, files and functions entered."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

#: command lines that are followed, by the name that the table shows
COMMANDS = {
    "import": (),
    "modes": ("modes", "geometry/pinion_overhung.toml", "-f", "timoshenko"),
    "answer": ("answer", "geometry/pinion_overhung.toml"),
    "deflect train": ("deflect", "geometry/gearbox_train.toml"),
}
#: run by a process of its own, in the checkout: counts what is entered of the package
FOLLOWER = """
import importlib, json, os, sys
package = os.path.join(os.getcwd(), "solidgear") + os.sep
entered = {}
def follow(frame, event, argument):
    code = frame.f_code
    if event == "call" and code.co_filename.startswith(package) and code.co_name[0] != "<":
        place = code.co_filename[len(package):]
        entered[place, code.co_qualname] = entered.get((place, code.co_qualname), 0) + 1
import solidgear
words = json.loads(sys.argv[1])
if words:
    app = "app" if os.path.isdir(package + "app") else "cli"
    main = importlib.import_module(f"solidgear.{app}").main
    sys.argv = ["solidgear", *words]
    sys.setprofile(follow)
    try:
        main()
    except SystemExit:
        pass
    sys.setprofile(None)
def room(place):
    names = place.split(os.sep)
    return ".".join(names[: 2 if names[0] == "core" else 1]).removesuffix(".py")
walk = [room(place) for place, _ in entered]  # functions in the order of their first call
loaded = [name for name in sys.modules if name.split(".")[0] == "solidgear"]
print()
print(json.dumps({
    "modules loaded": len(loaded),
    "files entered": len({place for place, _ in entered}),
    "rooms entered": len({room(place) for place, _ in entered}),
    "moves between rooms": sum(a != b for a, b in zip(walk, walk[1:])),
    "functions entered": len(entered),
    "calls": sum(entered.values()),
}))
"""


def followed(tree: Path, words: Sequence[str]) -> dict[str, int]:
    """Return what one command loads and enters."""
    run = subprocess.run(
        [sys.executable, "-c", FOLLOWER, json.dumps(list(words))],
        cwd=tree,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout.splitlines()[-1])


def all_followed(tree: Path) -> dict[str, dict[str, int]]:
    """Return what each of :data:`COMMANDS` loads and enters."""
    return {name: followed(tree, words) for name, words in COMMANDS.items()}
