"""A white picture that VTK draws without a screen, and what is put on it.

Surfaces are data sets of pyvista, which knows their edges and normals. They are put before VTK's
renderer here: pyvista's own plotter imports matplotlib, and takes 60 MB more and twice as long to
start for the same picture. Both are imported where they are used, for all else answers without them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.show.scales import rgb

if TYPE_CHECKING:
    from pyvista import PolyData

BLACK = "#000000"
#: colours of the axes x, y, z
AXES = ("#ff6347", "#2e8b57", "#0000ff")
#: share of the picture, across and up, that the axes take in its lower left
CORNER = (0.2, 0.34)
#: colours of a scale
STEPS = 256
#: foot and head of a scale as shares of the height of the picture
BAR = (0.02, 0.048)


def surface_of(points: np.ndarray, *faces: np.ndarray) -> PolyData:
    """Return a surface of faces (n, corners), each kind in an array of its own."""
    import pyvista as pv

    return pv.PolyData(points, np.concatenate([_listed(kind) for kind in faces]))


def wires_of(points: np.ndarray, lines: np.ndarray) -> PolyData:
    """Return pieces (n, 2) of lines between points."""
    import pyvista as pv

    return pv.PolyData(points, lines=_listed(lines))


def edges_of(surface: PolyData) -> PolyData:
    """Return the sharp edges of a surface, above 30°."""
    return surface.extract_feature_edges(
        feature_angle=30.0, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )


def _listed(cells: np.ndarray) -> np.ndarray:
    """Return cells as VTK lists them, the number of its corners before each."""
    return np.insert(cells, 0, cells.shape[1], axis=1).ravel()


@dataclass(frozen=True)
class Shading:
    """How much of its colour a surface has in the shade, gains from the lamps and mirrors."""

    ambient: float
    diffuse: float
    specular: float = 0.0


class Canvas:
    """A white picture of so many pixels, seen along a parallel projection."""

    def __init__(self, width: int, height: int):
        # the others bring fonts and what draws, and are not called
        from vtkmodules import (
            vtkRenderingCore,
            vtkRenderingFreeType,  # noqa: F401
            vtkRenderingOpenGL2,  # noqa: F401
        )

        self._window = vtkRenderingCore.vtkRenderWindow()
        self._window.SetOffScreenRendering(True)
        self._window.SetSize(width, height)
        # edges are smoothed in the picture instead: several samples a pixel take more memory and time
        self._window.SetMultiSamples(0)
        self._renderer = vtkRenderingCore.vtkRenderer()
        self._renderer.SetBackground(1, 1, 1)
        self._renderer.AutomaticLightCreationOff()
        self._renderer.UseFXAAOn()
        self._window.AddRenderer(self._renderer)
        self._bar = np.empty((0, 3), np.uint8)  # colours of a scale, a pixel each

    def aim(self, middle: np.ndarray, back: np.ndarray, upward: np.ndarray, height: float) -> None:
        """Look at a point from `back` of it, `height` of the scene filling the picture."""
        camera = self._renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*middle)
        camera.SetPosition(*(middle + back))
        camera.SetViewUp(*upward)
        camera.SetParallelScale(height / 2)

    def lamp(self, place: np.ndarray, strength: float) -> None:
        """Put a lamp that shines from a place towards the origin."""
        from vtkmodules.vtkRenderingCore import vtkLight

        lamp = vtkLight()
        lamp.SetPosition(*place)
        lamp.SetIntensity(strength)
        self._renderer.AddLight(lamp)

    def smooth(self, surface: PolyData, values: np.ndarray, scale: Any, look: Shading) -> None:
        """Draw a surface in the colours of values at its points, round but at edges above 35°."""
        surface.point_data["values"] = values
        rounded = surface.compute_normals(
            cell_normals=False, split_vertices=True, feature_angle=35.0
        )
        actor = self._coloured(rounded, scale, look)
        actor.GetMapper().SetScalarModeToUsePointFieldData()
        # colours between those of the corners, and not mixtures of these
        actor.GetMapper().InterpolateScalarsBeforeMappingOn()
        actor.GetProperty().SetInterpolationToPhong()

    def flat(self, surface: PolyData, values: np.ndarray, scale: Any, look: Shading) -> None:
        """Draw a surface, each of its faces in the colour of its value."""
        surface.cell_data["values"] = values
        actor = self._coloured(surface, scale, look)
        actor.GetMapper().SetScalarModeToUseCellFieldData()
        actor.GetProperty().SetInterpolationToFlat()

    def _coloured(self, surface: PolyData, scale: Any, look: Shading) -> Any:
        actor = self._shown(surface)
        mapper = actor.GetMapper()
        mapper.SelectColorArray("values")
        mapper.SetLookupTable(scale)
        mapper.UseLookupTableScalarRangeOn()
        actor.GetProperty().SetAmbient(look.ambient)
        actor.GetProperty().SetDiffuse(look.diffuse)
        actor.GetProperty().SetSpecular(look.specular)
        actor.GetProperty().SetSpecularPower(100)
        return actor

    def lines(
        self,
        wires: PolyData,
        colour: str,
        width: float,
        *,
        nearer: np.ndarray,
        opacity: float = 1.0,
    ) -> None:
        """Draw lines in one colour, moved nearer to the viewer."""
        actor = self._shown(wires)
        actor.GetMapper().ScalarVisibilityOff()
        actor.SetPosition(nearer)
        look = actor.GetProperty()
        look.SetColor(_rgb(colour))
        look.SetLineWidth(width)
        look.SetOpacity(opacity)
        look.LightingOff()

    def silhouette(self, surface: PolyData, colour: str, width: float) -> None:
        """Draw the border of a surface as the viewer sees it."""
        from vtkmodules.vtkFiltersHybrid import vtkPolyDataSilhouette

        border = vtkPolyDataSilhouette()
        border.SetInputData(surface)
        border.SetCamera(self._renderer.GetActiveCamera())
        border.SetEnableFeatureAngle(False)
        actor = self._shown()
        actor.GetMapper().SetInputConnection(border.GetOutputPort())
        actor.GetMapper().ScalarVisibilityOff()
        actor.GetProperty().SetColor(_rgb(colour))
        actor.GetProperty().SetLineWidth(width)

    def _shown(self, data: PolyData | None = None) -> Any:
        from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

        actor, mapper = vtkActor(), vtkPolyDataMapper()
        if data is not None:
            mapper.SetInputData(data)
        actor.SetMapper(mapper)
        self._renderer.AddActor(actor)
        return actor

    def words(self, words: str, height: float, size: int, across: float = 0.5) -> None:
        """Write words about a place at shares of the height and width of the picture."""
        from vtkmodules.vtkRenderingCore import vtkTextActor

        text = vtkTextActor()
        text.SetInput(words)
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        text.SetPosition(across, height)
        _set_font(text.GetTextProperty(), size)
        text.GetTextProperty().SetJustificationToCentered()
        self._renderer.AddViewProp(text)

    def bar(self, scale: Any, wide: float, size: int, labels: int, form: str) -> None:
        """Draw a scale of colours with its numbers at the foot, over a share of the width."""
        import pyvista as pv

        colours = pv.convert_array(scale.GetTable())[:, :3]
        width = round(wide * self._window.GetSize()[0])
        # VTK's own bar has its numbers beside their places until all is drawn once more
        self._bar = colours[np.arange(width) * len(colours) // width]
        low, high = scale.GetRange()
        for share in np.linspace(0, 1, labels):
            value = low + share * (high - low)
            if scale.UsingLogScale():
                value = low * (high / low) ** share
            self.words(form % value, BAR[1] + 0.01, size, (1 - wide) / 2 + wide * share)

    def axes(self) -> None:
        """Draw the axes in the lower left, as they stand to the viewer: after :meth:`aim`."""
        from vtkmodules.vtkRenderingAnnotation import vtkAxesActor
        from vtkmodules.vtkRenderingCore import vtkRenderer

        axes = vtkAxesActor()
        for axis, colour in zip("XYZ", AXES):
            shaft = getattr(axes, f"Get{axis}AxisShaftProperty")()
            tip = getattr(axes, f"Get{axis}AxisTipProperty")()
            for part in (shaft, tip):
                part.SetColor(_rgb(colour))
                part.SetAmbient(0.5)
            shaft.SetLineWidth(4)
            getattr(axes, f"Set{axis}AxisLabelText")(axis.lower())
            label = getattr(axes, f"Get{axis}AxisCaptionActor2D")()
            label.SetWidth(0.25)
            label.SetHeight(0.13)
            label.GetCaptionTextProperty().SetColor(_rgb(BLACK))
            label.GetCaptionTextProperty().ShadowOff()
        # in a picture of their own above the other, in front of whatever stands there
        corner = vtkRenderer()
        corner.SetLayer(1)
        corner.SetViewport(0, 0, *CORNER)
        corner.AddActor(axes)
        camera, whole = corner.GetActiveCamera(), self._renderer.GetActiveCamera()
        camera.SetPosition(whole.GetPosition())
        camera.SetFocalPoint(whole.GetFocalPoint())
        camera.SetViewUp(whole.GetViewUp())
        self._window.SetNumberOfLayers(2)
        self._window.AddRenderer(corner)
        corner.ResetCamera()  # to the shape of the corner, which it has of its window

    def pixels(self) -> np.ndarray:
        """Return the picture (height, width, 3); nothing can be put on it any more."""
        import pyvista as pv
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        self._renderer.ResetCameraClippingRange()
        self._window.Render()
        seen = vtkWindowToImageFilter()
        seen.SetInput(self._window)
        seen.ShouldRerenderOff()
        seen.ReadFrontBufferOff()
        seen.Update()
        image = pv.wrap(seen.GetOutput())
        width, height, _ = image.dimensions
        # from the foot up
        pixels = image.active_scalars.reshape(height, width, 3).copy()
        foot, head = (round(share * height) for share in BAR)
        left = (width - len(self._bar)) // 2
        pixels[foot:head, left : left + len(self._bar)] = self._bar
        self._window.Finalize()
        return pixels[::-1]


def scale_of(ramp: Sequence[str], ends: tuple[float, float], *, log: bool = False) -> Any:
    """Return VTK's scale whose colours run evenly through those of a ramp."""
    from vtkmodules.vtkCommonCore import vtkLookupTable

    scale = vtkLookupTable()
    if log:
        scale.SetScaleToLog10()
    scale.SetRange(*ends)
    scale.SetNumberOfTableValues(STEPS)
    places, given = np.linspace(0, 1, STEPS), np.linspace(0, 1, len(ramp))
    parts = [np.interp(places, given, part) for part in np.transpose([_rgb(c) for c in ramp])]
    for k, colour in enumerate(zip(*parts)):
        scale.SetTableValue(k, *colour)
    return scale


def _rgb(colour: str) -> np.ndarray:
    return rgb(colour) / 255


def _set_font(text: Any, size: int) -> None:
    text.SetFontFamilyToArial()
    text.SetFontSize(size)
    text.SetColor(_rgb(BLACK))
    text.ShadowOff()
    text.ItalicOff()
    text.BoldOff()
