# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a body: body, foundation, axes, colour bars, title."""
import dataclasses

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import cm, collections, colors, lines, patches, ticker  # noqa: E402

import view  # noqa: E402
from axes_of_space import AxesOfSpace  # noqa: E402
from fields import CATEGORIES, coloring, is_category, label  # noqa: E402
from panels import is_seen, level_directions, panels, upwards  # noqa: E402, F401
from style import LIGHT, STYLES  # noqa: E402
from surface import VALUE  # noqa: E402
from text import GAP, SMALL, TITLE, in_lines, width_of  # noqa: E402

LARGEST = (9.0, 6.0)  # inches of a panel in the plane
PANEL = (5.4, 5.0)  # in space
MARGIN = 0.03  # around what is drawn, of its size
BAR = 1.15  # inches that a colour bar takes, with its numbers


def fields_of(scene):
    """{layer: the field that it shows}"""
    fields = {"contact": scene.contact_field, "body": scene.body_field}
    return {layer: field for layer, field in fields.items() if field and len(scene.layers.get(layer, ()))}


def colorings(scene, style=LIGHT):
    """{layer: (norm, colour map)}"""
    return {layer: coloring(field, scene.layers[layer][..., VALUE], layer == "contact", style, lambda field=field: scene.result.peak(field))
            for layer, field in fields_of(scene).items()}


@dataclasses.dataclass
class Layout:
    """Where the parts of the picture are [inches]. From the left: panels with their axes, colour bars. From below: legend, panels,
    captions, title."""

    panel: tuple  # width and height of each
    pad: tuple  # what axes take to the left of and below a panel
    panels: int
    bars: int
    title: list  # lines
    legend: float  # width
    captions: float  # height

    def __post_init__(self):
        content = self.panels * (self.panel[0] + self.pad[0]) + 0.35 + BAR * self.bars + GAP
        self.width = max(content, self.legend + 2 * GAP, *(width_of(line, TITLE) + 2 * GAP for line in self.title))
        self.left = 0.5 * (self.width - content)
        self.middle = max(self.panel[1], 1.9)  # height for the panels, or colour bars
        self.below = self.pad[1] + 0.35
        self.height = self.below + self.middle + self.captions + 0.26 * len(self.title) + 2 * GAP

    def place(self, figure, left, bottom, width, height):
        """Axes there."""
        return figure.add_axes([left / self.width, bottom / self.height, width / self.width, height / self.height])

    def panel_axes(self, figure, k):
        """Of the k-th panel."""
        left = self.left + self.pad[0] + k * (self.panel[0] + self.pad[0])
        return self.place(figure, left, self.below + 0.5 * (self.middle - self.panel[1]), *self.panel)

    def bar_axes(self, figure, k):
        """Of the k-th colour bar."""
        left = self.left + self.panels * (self.panel[0] + self.pad[0]) + 0.35 + BAR * k
        return self.place(figure, left, self.below + 0.08 * self.middle, 0.16, 0.84 * self.middle)


def compose(scene, direction=None, style=None):
    """The picture as a figure.

    @param direction  in space, from the body to the viewer; None: chosen
    @param style      None: light
    """
    style = style or STYLES["light"]
    with plt.rc_context(style.rc()):
        return composed(scene, direction, style)


def composed(scene, direction, style):
    """The same, with what the style sets in Matplotlib."""
    flat = scene.result.dim == 2
    shown = panels(scene, direction)
    windows = [windowed(scene, panel) for panel in shown]
    size = [max(window[2 * d + 1] - window[2 * d] for window in windows) for d in (0, 1)]  # [m]
    inches = min(most / length for most, length in zip(LARGEST if flat else PANEL, size))
    windows = [widened(window, size) for window in windows]
    drawings = [AxesOfSpace(scene, panel, window, inches, style) for panel, window in zip(shown, windows)] if not flat else []
    handles, parts = legend_handles(scene, style), title_parts(scene)
    legend = sum(width_of(handle.get_label(), SMALL) + 0.7 for handle in handles)
    pad = pad_of_plane(scene, windows[0], size, inches) if flat else tuple(np.max([drawing.pad() for drawing in drawings], axis=0))
    fields, chosen = fields_of(scene), colorings(scene, style)
    panel_size = (size[0] * inches, size[1] * inches)
    content = len(shown) * (panel_size[0] + pad[0]) + BAR * len(fields)
    captions = 0.3 if any(panel.caption for panel in shown) else 0.1
    layout = Layout(panel_size, pad, len(shown), len(fields), in_lines(parts, content), legend, captions)
    figure = plt.figure(figsize=(layout.width, layout.height), dpi=style.dpi)
    for k, (panel, window) in enumerate(zip(shown, windows)):
        axes = layout.panel_axes(figure, k)
        image = view.paint(scene, panel.view, window, inches * style.dpi, chosen, panel.without, style)
        axes.imshow(image, extent=window, origin="lower", interpolation="none", zorder=2, aspect="auto")
        if flat:
            add_axes_of_plane(axes, scene, window, panel_size, style)
        else:
            drawings[k].draw(axes)
            axes.set_title(panel.caption, fontsize=10, color=style.faint)
    for k, (name, field) in enumerate(fields.items()):
        add_color_bar(layout.bar_axes(figure, k), label(field, scene.result.units), field, *chosen[name], scene.states(field))
    figure.text(0.5, 1 - GAP / layout.height, "\n".join(layout.title), ha="center", va="top", fontsize=TITLE)
    if handles:
        figure.legend(handles=handles, loc="lower center", ncols=len(handles), frameon=False, fontsize=SMALL)
    return figure


def windowed(scene, panel):
    """(left, right, bottom, top) of a panel [m]."""
    window = view.bounds(scene, panel.view, panel.without)
    return window if scene.window is not None and scene.result.dim == 2 else grown(window, MARGIN)


def pad_of_plane(scene, window, size, inches):
    """Inches that axes in the plane take to the left and below: measured."""
    figure = plt.figure(figsize=(size[0] * inches + 4, size[1] * inches + 4), dpi=LIGHT.dpi)
    axes = figure.add_axes([2 / (size[0] * inches + 4), 2 / (size[1] * inches + 4), *(s * inches / (s * inches + 4) for s in size)])
    label_plane(axes, scene, window, (size[0] * inches, size[1] * inches))
    outside, inside = axes.get_tightbbox(), axes.get_window_extent()
    plt.close(figure)
    return max(0.85, (inside.x0 - outside.x0) / LIGHT.dpi + GAP), max(0.6, (inside.y0 - outside.y0) / LIGHT.dpi + GAP)


def draw_plane(axes, scene, resolution=1000):
    """Draws a body in the plane into axes of another figure.

    @param resolution  pixels that the longer side gets
    @return what a colour bar of the body's field takes
    """
    window = grown(view.bounds(scene, view.FRONT), MARGIN)
    chosen = colorings(scene)
    pixels = resolution / max(window[1] - window[0], window[3] - window[2])
    axes.imshow(view.paint(scene, view.FRONT, window, pixels, chosen), extent=window, origin="lower", zorder=2)
    add_axes_of_plane(axes, scene, window)
    axes.grid(False)
    return cm.ScalarMappable(*chosen["body"])


def add_axes_of_plane(axes, scene, window, size=None, style=LIGHT):
    """Axes with units, and the outline of the undeformed body. @param size  of the axes [inches], if known"""
    axes.add_collection(collections.LineCollection(scene.rest[..., :2], **style.rest, zorder=3))
    label_plane(axes, scene, window, size)


def few_ticks(low, high, room):
    """Where an axis has numbers if there is room for so many; a single one if there is none for two."""
    locator = ticker.MaxNLocator(int(np.clip(room, 1, 10)), steps=[1, 2, 2.5, 5, 10])
    if room >= 2:
        return locator
    inside = [tick for tick in locator.tick_values(low, high) if low <= tick <= high]
    return ticker.FixedLocator(inside[:1])


def label_plane(axes, scene, window, size=None):
    """Ticks and names of the axes; numbers no closer than they are wide."""
    if size:
        decimals = int(np.clip(np.ceil(-np.log10(window[1] - window[0])) + 2, 0, 12))
        number = max((f"{value:.{decimals}f}" for value in window[:2]), key=len)
        axes.xaxis.set_major_locator(few_ticks(*window[:2], size[0] / max(0.8, width_of(number, 10) + 0.3)))
        axes.yaxis.set_major_locator(few_ticks(*window[2:], size[1] / 0.45))
    unit_of_length = scene.result.units["length"]
    axes.set(xlim=window[:2], ylim=window[2:], xlabel=f"x [{unit_of_length}]", ylabel=f"y [{unit_of_length}]")
    axes.spines[["top", "right"]].set_visible(False)


def grown(window, part):
    """A window with a margin, a part of its larger side."""
    left, right, bottom, top = window
    margin = part * max(right - left, top - bottom)
    return left - margin, right + margin, bottom - margin, top + margin


def widened(window, size):
    """A window of that size (width, height) around the same centre."""
    x, y = 0.5 * (window[0] + window[1]), 0.5 * (window[2] + window[3])
    return x - 0.5 * size[0], x + 0.5 * size[0], y - 0.5 * size[1], y + 0.5 * size[1]


def title_parts(scene):
    """What is drawn, and how much the displacements are enlarged."""
    result = scene.result
    parts = [result.title[:60], f"displacements \u00d7 {scene.scale:g}"]
    if result.num_times > 1:
        parts.insert(1, f"t = {result.time:g}")
    if scene.cut:
        parts.append(f"cut at {'xyz'[scene.cut.axis]} = {scene.cut.value:g} {result.units['length']}")
    return [part for part in parts if part]


def add_color_bar(axes, text, field, norm, colors_of, states):
    """A colour bar with its name and unit; of a category its names beside their colours. @param states  numbers of those that occur"""
    if is_category(field):
        return add_names(axes, text, [(CATEGORIES[field][state], colors_of(norm(state))) for state in states])
    bar = axes.figure.colorbar(cm.ScalarMappable(norm, colors_of), cax=axes)
    bar.set_label(text)
    bar.outline.set_linewidth(0.5)
    if isinstance(norm, colors.LogNorm):
        return None
    bar.formatter.set_powerlimits((-3, 5))
    return bar.update_ticks()


def add_names(axes, text, names):
    """The legend of a category, where else a colour bar is: its name above. @param names  [(name, colour)]"""
    width, height = (axes.get_position().size * axes.figure.get_size_inches()).tolist()  # of the axes [inches]
    axes.set(xlim=(0, width), ylim=(0, height))
    axes.set_axis_off()
    y = 0.5 * height + 0.15 * len(names)
    axes.text(0, y + 0.1, text, va="bottom", fontsize=SMALL)
    for name, colour in names:
        y -= 0.3
        axes.add_patch(patches.Rectangle((0, y), 0.16, 0.2, facecolor=colour, edgecolor=plt.rcParams["text.color"], linewidth=0.5))
        axes.text(0.24, y + 0.1, name, va="center", fontsize=SMALL)


def legend_handles(scene, style=LIGHT):
    """What is no field: below the panels."""
    handles = []
    if scene.rest is not None:
        handles.append(lines.Line2D([], [], **style.rest, label="undeformed body"))
    if any(len(scene.layers.get(name, ())) for name in view.GROUND_LAYERS):
        handles.append(patches.Patch(facecolor=style.ground, edgecolor=style.ink, linewidth=0.6, label="foundation"))
    handles += [zone_handle(scene, zone, color) for zone, color in style.zones.items() if shows(scene, zone)]
    if len(scene.layers.get("arrows", ())):
        text = f"friction, of the body on the foundation: at most {scene.shear:.3g} {scene.result.units['stress']}"
        handles.append(lines.Line2D([], [], color=style.ink, linestyle="", marker=r"$\rightarrow$", markersize=15, label=text))
    return handles


def shows(scene, zone):
    """Whether a zone of friction is drawn."""
    return len(scene.layers.get(zone, ())) > 0 or any(lines.zone == zone for lines in scene.lines)


def zone_handle(scene, zone, color):
    """A zone in the legend: an area in the plane, its border in space."""
    if scene.result.dim == 2:
        return patches.Patch(facecolor=color, label=zone)
    return lines.Line2D([], [], color=color, linewidth=2.5, label=zone)
