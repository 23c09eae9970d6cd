"""gmsh, loaded when needed, and a model in it that leaves no trace."""

from typing import Any

from solidgear.core.machine.interruptible import abandoned
from solidgear.core.meshing.quality import MeshError

_APT = (
    "apt-get install libglu1-mesa libgl1 libegl1 libegl-mesa0 libxft2 libxinerama1 libxcursor1 "
    "libgomp1"
)


def import_gmsh() -> Any:
    """Return the module gmsh; MeshError if it or a system library it needs is missing, with the
    packages to install.
    """
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise MeshError(
            f"gmsh cannot be loaded ({error}); install its wheel (pip install gmsh; there is none "
            "for Linux on ARM, whose distributions have it as python3-gmsh) and the system "
            f"libraries it needs: {_APT}; beams, the harmonic solid and hexahedra do without it"
        ) from error
    return gmsh


class Session:
    """A gmsh model that leaves no trace in a gmsh the caller may already be using.

    A context manager; the options of gmsh are as they were afterwards.
    """

    options = {
        "General.Terminal": 0,
        "General.NumThreads": 1,  # the order of the elements depends on the number of threads
        "Mesh.RandomSeed": 1,
        "Mesh.Algorithm": 6,
        "Mesh.Algorithm3D": 1,
        "Mesh.Optimize": 1,
        "Mesh.ElementOrder": 2,
        "Mesh.SecondOrderLinear": 0,
        "Mesh.SecondOrderIncomplete": 0,
        "Mesh.HighOrderOptimize": 0,
        "Mesh.MeshSizeFromPoints": 0,  # the size is the field's alone
        "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.MeshSizeExtendFromBoundary": 0,
        "Mesh.MeshSizeFactor": 1,
        "Mesh.MeshSizeMin": 0,
        "Mesh.MeshSizeMax": 1e22,
        # of the length of a curve in elements: at the 1e-9 of gmsh a formula of size is read so often
        # that points on curves take as long as surfaces and volumes together
        "Mesh.LcIntegrationPrecision": 1e-6,
        "Mesh.SaveAll": 0,
    }

    def __init__(self, gmsh):
        self.gmsh = gmsh

    def __enter__(self):
        gmsh = self.gmsh
        self.ours = not gmsh.isInitialized()
        if self.ours:
            # configuration files would make the mesh depend on the machine
            gmsh.initialize(["gmsh", "-v", "0"], readConfigFiles=False, interruptible=False)
        self.before, self.model = {}, None
        if not self.ours:
            self.before = {name: gmsh.option.getNumber(name) for name in self.options}
            self.model = gmsh.model.getCurrent()
        for name, value in self.options.items():
            gmsh.option.setNumber(name, value)
        names = set(gmsh.model.list())
        number = 0
        while f"solidgear{number}" in names:
            number += 1
        self.name = f"solidgear{number}"
        gmsh.model.add(self.name)

    def __exit__(self, *exception):
        gmsh = self.gmsh
        if abandoned():
            return  # gmsh is still meshing after Ctrl-C: its model must stay
        if self.ours:
            gmsh.finalize()
            return
        gmsh.model.setCurrent(self.name)
        gmsh.model.remove()
        if self.model in gmsh.model.list():
            gmsh.model.setCurrent(self.model)
        for name, value in self.before.items():
            gmsh.option.setNumber(name, value)
