"""Picture of the deformed beam with its von Mises stress, from the Exodus file of input/beam.xml.

    pvbatch --force-offscreen-rendering beam_von_mises.py beam.e beam_von_mises.png

ParaView 5.11 (Debian package python3-paraview), which needs an X server, or xvfb-run in front. The displacement is amplified,
and with it the imprint that the beam leaves in the foundation. Lines: the beam at rest, and the foundation's surface y = 0.
"""
import math
import sys

from paraview.simple import *  # noqa: F403, ParaView's own custom

AMPLIFICATION = 10
SIZE = [1600, 620]  # pixels
FOCUS, HALF_HEIGHT = (2.42, 0.395), 1.06  # m, what the picture shows
FLOOR = -0.34  # m, lower end of what is drawn of the foundation
INK = [0.15, 0.15, 0.15]


def line(points, width, view, color=INK):
    display = Show(PolyLineSource(Points=[c for p in points for c in p]), view)
    display.ColorArrayName = [None, ""]
    display.AmbientColor = display.DiffuseColor = color
    display.LineWidth = width


def label(text, x, y, size, view):
    display = Show(Text(Text=text), view)
    display.WindowLocation = "Any Location"
    display.Position = [x, y]
    display.FontSize = size
    display.Color = INK


def beam(path, view):
    reader = ExodusIIReader(FileName=[path])
    reader.PointVariables = reader.PointVariables.Available
    reader.ApplyDisplacements = 0
    warp = WarpByVector(Input=reader, Vectors=["POINTS", "disp_"], ScaleFactor=AMPLIFICATION)
    display = Show(warp, view)
    display.Representation = "Surface"
    ColorBy(display, ("POINTS", "von_mises"))
    colors = GetColorTransferFunction("von_mises")
    colors.ApplyPreset("Viridis (matplotlib)", True)
    warp.UpdatePipeline()
    top = 5 * math.ceil(warp.PointData["von_mises"].GetRange()[1] / 5)
    colors.RescaleTransferFunction(0, top)
    return colors, top


def foundation(view):
    block = Box(XLength=5, YLength=-FLOOR, ZLength=0.001, Center=[2.5, FLOOR / 2, -0.1])
    display = Show(block, view)
    display.ColorArrayName = [None, ""]
    display.AmbientColor = display.DiffuseColor = [0.87, 0.86, 0.84]
    display.Ambient, display.Diffuse = 1, 0
    line([(0, 0, 0.1), (5, 0, 0.1)], 2, view)


def outline(view):
    line([(0, 0, 0.1), (0, 1, 0.1), (5, 1, 0.1), (5, 0, 0.1)], 1.5, view)


def color_bar(colors, top, view):
    bar = GetScalarBar(colors, view)
    bar.Title, bar.ComponentTitle = "von Mises stress [Pa]", ""
    bar.Orientation, bar.WindowLocation = "Horizontal", "Any Location"
    bar.Position, bar.ScalarBarLength, bar.ScalarBarThickness = [0.31, 0.845], 0.4, 16
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize = 20, 18
    bar.AutomaticLabelFormat, bar.LabelFormat = 0, "%.0f"
    bar.UseCustomLabels, bar.AddRangeLabels = 1, 0
    bar.CustomLabels = [5 * k for k in range(top // 5 + 1)]


def axes(view):
    grid = view.AxesGrid
    grid.Visibility = 1
    grid.UseCustomBounds, grid.CustomBounds = 1, [0, 5, FLOOR, 1, 0, 0]
    grid.XTitle, grid.YTitle, grid.ZTitle = "x [m]", "y [m]", ""
    grid.XAxisUseCustomLabels, grid.XAxisLabels = 1, [0, 1, 2, 3, 4, 5]
    grid.YAxisUseCustomLabels, grid.YAxisLabels = 1, [0, 0.5, 1]
    grid.AxesToLabel = 3  # lower x, lower y
    for axis in "XY":
        for what, size in (("Title", 20), ("Label", 18)):
            setattr(grid, axis + what + "Color", INK)
            setattr(grid, axis + what + "FontSize", size)
    grid.GridColor = INK


def main(exodus, picture):
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    view.UseFXAA = 1
    view.UseLight = 0  # colours as in the colour bar
    colors, top = beam(exodus, view)
    foundation(view)
    outline(view)
    color_bar(colors, top, view)
    axes(view)
    x, y = FOCUS
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [x, y, 0], [x, y, 10], [0, 1, 0]
    view.CameraParallelScale = HALF_HEIGHT
    label("displacement \u00d7 %d" % AMPLIFICATION, 0.80, 0.80, 18, view)
    label("foundation", 0.475, 0.185, 18, view)
    SaveScreenshot(picture, view, ImageResolution=SIZE, CompressionLevel="9")


if __name__ == "__main__":
    main(*sys.argv[1:])
