# SPDX-License-Identifier: BSD-3-Clause
"""The picture: body, foundation, axes, colour bars, title."""
import dataclasses
import io
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import cm, collections, colors, lines, patches, textpath, ticker  # noqa: E402

import view  # noqa: E402
from result import PictureError  # noqa: E402
from scene import largest_gap  # noqa: E402
from surface import VALUE, outward, unit  # noqa: E402

DPI = 140
LARGEST = (9.0, 6.0)  # inches of a panel in the plane
PANEL = (5.4, 5.0)  # in space
STATES = ["open", "closed", "yielding"]
REST = {"color": "0.45", "linewidth": 0.8}  # outline of the undeformed body
MARGIN = 0.03  # around what is drawn, of its size
ROUNDING = 1e-6  # of the largest value of a film: less is drawn as 0
SEEN = 0.2  # cosine from which on a face is seen
TITLE, SMALL = 12, 9  # points
BAR = 1.15  # inches that a colour bar takes, with its numbers
GAP = 0.15  # inches between texts and what is beside them
NUMBER = 8  # points of the numbers along the axes in space


def label(name, units):
    """What a colour bar says of a field. @param units  see Result"""
    axes = name.rsplit("_", 1)[-1]
    if name in ("gap", "dent", "penetration"):
        return f"{name} [{units['length']}]"
    if name.startswith("disp_"):
        return f"displacement in {axes} [{units['length']}]"
    if name == "contact_pressure":
        return f"contact pressure [{units['stress']}]"
    if name == "von_mises":
        return f"von Mises stress [{units['stress']}]"
    if name.startswith("stress_"):
        return rf"stress $\sigma_{{{axes}}}$ [{units['stress']}]"
    return name.replace("_", " ")


def coloring(name, values, contact, peak=lambda: 0.0):
    """(norm, colour map) of a field with these values. @param peak  tells the largest one of the whole film"""
    values = values[np.isfinite(values)]
    if name == "contact_status":
        return colors.BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3), colors.ListedColormap(["#d9d9d9", "#4292c6", "#cb181d"])
    low, high = (values.min(), values.max()) if len(values) else (0.0, 1.0)
    if name in ("contact_pressure", "von_mises", "dent", "penetration"):
        low, high = 0.0, max(high, 0.0)
        most = peak()
        high = most if high <= ROUNDING * most else high  # an unloaded body would show rounding errors
    if high - low <= 1e-12 * max(abs(low), abs(high)):
        high = low + (abs(low) or 1.0)
    if low < 0 < high and min(-low, high) > 0.1 * max(-low, high):
        limit = max(-low, high)
        return colors.Normalize(-limit, limit), color_map("coolwarm")
    return colors.Normalize(low, high), color_map("YlOrRd", 0.85) if contact else color_map("viridis")


def color_map(name, end=1.0):
    """A colour map up to a part of it, grey where a block lacks the field."""
    return colors.ListedColormap(plt.get_cmap(name)(np.linspace(0, end, 256))).with_extremes(bad="0.75")


def fields_of(scene):
    """{layer: the field that it shows}"""
    fields = {"contact": scene.contact_field, "body": scene.body_field}
    return {layer: field for layer, field in fields.items() if field and len(scene.layers.get(layer, ()))}


def colorings(scene):
    """{layer: (norm, colour map)}"""
    return {layer: coloring(field, scene.layers[layer][..., VALUE], layer == "contact", lambda field=field: scene.result.peak(field))
            for layer, field in fields_of(scene).items()}


def upwards(scene):
    """The axis of space that leads away from the foundation; z without one."""
    main = abs(scene.normal).argmax() if abs(scene.normal).max() > 0.5 else 2
    up = np.zeros(3)
    up[main] = -1 if scene.normal[main] > 0.5 else 1
    return up


def level_directions(scene, up):
    """Directions to the viewer, level: four, or two that see into the cut; first the one from which most stress is seen."""
    first, second = (np.eye(3)[(abs(up).argmax() + k) % 3] for k in (1, 2))
    candidates = [a * first + b * second for a, b in ((0.8, -0.6), (-0.8, -0.6), (0.8, 0.6), (-0.8, 0.6))]
    if scene.cut:
        out = scene.cut.towards * np.eye(3)[scene.cut.axis]
        candidates = [c for c in candidates if c @ out > 0] or candidates
    rows = scene.layers["body"]
    sides = np.cross(rows[:, 1, :3] - rows[:, 0, :3], rows[:, 2, :3] - rows[:, 0, :3])
    seen = [(np.clip(sides @ c, 0, None) * abs(np.nan_to_num(rows[..., VALUE].mean(axis=1)))).sum() for c in candidates]
    best = next(k for k, amount in enumerate(seen) if amount >= 0.98 * max(seen))
    return [candidates[best], *candidates[:best], *candidates[best + 1 :]]


def is_seen(scene, side, direction):
    """Whether the larger part of what a contact side bears, or of the side if it bears nothing, looks towards the viewer."""
    normals = np.concatenate([outward(face, scene.result.positions) for face in side.faces])
    sizes = np.linalg.norm(normals, axis=1)
    pressure = np.concatenate([side.fields["contact_pressure"][face.nodes].mean(axis=1) for face in side.faces])
    weights = sizes * np.maximum(pressure, 0) if pressure.max() > 0 else sizes
    return weights[normals @ unit(direction) > SEEN * sizes].sum() > 0.5 * weights.sum()


@dataclasses.dataclass
class Panel:
    """One view of the body, and the layers that it leaves out."""

    view: view.View
    caption: str = ""
    without: tuple = ()


def panels(scene, direction):
    """[Panel]: one, or in space two if contact sides show their field; the second one sees those that the first one does not."""
    if scene.result.dim == 2:
        return [Panel(view.FRONT)]
    up = upwards(scene)
    if direction is not None:
        return [Panel(view.view_from(direction, up))]
    levels = level_directions(scene, up)
    first = levels[0] + 0.45 * up
    if not scene.contact_field or not scene.sides:
        return [Panel(view.view_from(first, up))]
    hidden = [side for side in scene.sides if not is_seen(scene, side, first)]
    below = max((level - 0.7 * up for level in levels), key=lambda towards: sum(is_seen(scene, side, towards) for side in hidden))
    return [Panel(view.view_from(first, up), "on the foundation"), Panel(view.view_from(below, -up), "turned over", view.GROUND_LAYERS)]


def draw(scene, direction=None):
    """The picture as the bytes of a PNG.

    @param direction  in space, from the body to the viewer; None: chosen
    """
    figure = compose(scene, direction)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=DPI)
    plt.close(figure)
    return file.getvalue()


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


def compose(scene, direction=None):
    """The picture as a figure."""
    flat = scene.result.dim == 2
    shown = panels(scene, direction)
    windows = [windowed(scene, panel) for panel in shown]
    size = [max(window[2 * d + 1] - window[2 * d] for window in windows) for d in (0, 1)]  # [m]
    inches = min(most / length for most, length in zip(LARGEST if flat else PANEL, size))
    windows = [widened(window, size) for window in windows]
    drawings = [AxesOfSpace(scene, panel, window, inches) for panel, window in zip(shown, windows)] if not flat else []
    handles, parts = legend_handles(scene), title_parts(scene)
    legend = sum(width_of(handle.get_label(), SMALL) + 0.7 for handle in handles)
    pad = pad_of_plane(scene, windows[0], size, inches) if flat else tuple(np.max([drawing.pad() for drawing in drawings], axis=0))
    fields, chosen = fields_of(scene), colorings(scene)
    panel_size = (size[0] * inches, size[1] * inches)
    content = len(shown) * (panel_size[0] + pad[0]) + BAR * len(fields)
    captions = 0.3 if any(panel.caption for panel in shown) else 0.1
    layout = Layout(panel_size, pad, len(shown), len(fields), in_lines(parts, content), legend, captions)
    figure = plt.figure(figsize=(layout.width, layout.height), dpi=DPI)
    for k, (panel, window) in enumerate(zip(shown, windows)):
        axes = layout.panel_axes(figure, k)
        image = view.paint(scene, panel.view, window, inches * DPI, chosen, panel.without)
        axes.imshow(image, extent=window, origin="lower", interpolation="none", zorder=2, aspect="auto")
        if flat:
            add_axes_of_plane(axes, scene, window, panel_size)
        else:
            drawings[k].draw(axes)
            axes.set_title(panel.caption, fontsize=10, color="0.3")
    for k, (name, field) in enumerate(fields.items()):
        add_color_bar(layout.bar_axes(figure, k), label(field, scene.result.units), field, *chosen[name])
    figure.text(0.5, 1 - GAP / layout.height, "\n".join(layout.title), ha="center", va="top", fontsize=TITLE)
    if handles:
        figure.legend(handles=handles, loc="lower center", ncols=len(handles), frameon=False, fontsize=SMALL)
    return figure


def windowed(scene, panel):
    """(left, right, bottom, top) of a panel [m]."""
    window = view.bounds(scene, panel.view, panel.without)
    return window if scene.window is not None and scene.result.dim == 2 else grown(window, MARGIN)


def width_of(text, points):
    """Inches that a line of text takes."""
    return textpath.TextPath((0, 0), text, size=points).get_extents().width / 72 + 0.02 if text.strip() else 0.0


def in_lines(parts, width):
    """Parts of the title in lines that fit a width [inches], as far as the parts do."""
    found = [parts[0]]
    for part in parts[1:]:
        longer = f"{found[-1]}    {part}"
        if width_of(longer, TITLE) <= width:
            found[-1] = longer
        else:
            found.append(part)
    return found


def pad_of_plane(scene, window, size, inches):
    """Inches that axes in the plane take to the left and below: measured."""
    figure = plt.figure(figsize=(size[0] * inches + 4, size[1] * inches + 4), dpi=DPI)
    axes = figure.add_axes([2 / (size[0] * inches + 4), 2 / (size[1] * inches + 4), *(s * inches / (s * inches + 4) for s in size)])
    label_plane(axes, scene, window, (size[0] * inches, size[1] * inches))
    outside, inside = axes.get_tightbbox(), axes.get_window_extent()
    plt.close(figure)
    return max(0.85, (inside.x0 - outside.x0) / DPI + GAP), max(0.6, (inside.y0 - outside.y0) / DPI + GAP)


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


def add_axes_of_plane(axes, scene, window, size=None):
    """Axes with units, and the outline of the undeformed body. @param size  of the axes [inches], if known"""
    axes.add_collection(collections.LineCollection(scene.rest[..., :2], **REST, zorder=3))
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
    moved = "displacements"
    if scene.scale > 1 and largest_gap(result) > 1e-9 * result.size():
        moved += " and gaps"
    parts = [result.title[:60], f"{moved} \u00d7 {scene.scale:g}"]
    if result.num_times > 1:
        parts.insert(1, f"t = {result.time:g}")
    if scene.cut:
        parts.append(f"cut at {'xyz'[scene.cut.axis]} = {scene.cut.value:g} {result.units['length']}")
    return [part for part in parts if part]


def add_color_bar(axes, text, field, norm, colors_of):
    """A colour bar with its name and unit."""
    bar = axes.figure.colorbar(cm.ScalarMappable(norm, colors_of), cax=axes)
    bar.set_label(text)
    bar.outline.set_linewidth(0.5)
    if field == "contact_status":
        bar.set_ticks([0, 1, 2], labels=STATES, rotation=90, va="center")
        bar.ax.tick_params(length=0)
        return
    bar.formatter.set_powerlimits((-3, 5))
    bar.update_ticks()


def legend_handles(scene):
    """What is no field: below the panels."""
    handles = []
    if scene.rest is not None:
        handles.append(lines.Line2D([], [], **REST, label="undeformed body"))
    if any(len(scene.layers.get(name, ())) for name in view.GROUND_LAYERS):
        handles.append(patches.Patch(facecolor=view.GROUND, edgecolor=view.INK, linewidth=0.6, label="foundation"))
    handles += [zone_handle(scene, zone, color) for zone, color in view.ZONES.items() if shows(scene, zone)]
    if len(scene.layers.get("arrows", ())):
        text = f"friction, of the body on the foundation: at most {scene.shear:.3g} {scene.result.units['stress']}"
        handles.append(lines.Line2D([], [], color=view.INK, linestyle="", marker=r"$\rightarrow$", markersize=15, label=text))
    return handles


def shows(scene, zone):
    """Whether a zone of friction is drawn."""
    return len(scene.layers.get(zone, ())) > 0 or any(lines.zone == zone for lines in scene.lines)


def zone_handle(scene, zone, color):
    """A zone in the legend: an area in the plane, its border in space."""
    if scene.result.dim == 2:
        return patches.Patch(facecolor=color, label=zone)
    return lines.Line2D([], [], color=color, linewidth=2.5, label=zone)


class AxesOfSpace:
    """The three edges of the box around all that is drawn that lie at the rim of the picture, with ticks.

    lines  [(2 ends, 2)] and texts [(text, place (2,), size (2,), points)], to the right and upwards from the panel's centre [inches]
    """

    def __init__(self, scene, panel, window, inches):
        points = view.points_of(scene, panel.without)
        self.low, self.high = points.min(axis=0), points.max(axis=0)
        self.view, self.inches, self.unit = panel.view, inches, scene.result.units["length"]
        self.centre = np.array([0.5 * (window[0] + window[1]), 0.5 * (window[2] + window[3])])
        self.half = 0.5 * inches * np.array([window[1] - window[0], window[3] - window[2]])
        self.lines, self.texts, names = [], [], []
        for d in range(3):
            if np.linalg.norm(self.view.project(np.eye(3)[d])[:2]) > 0.1:  # else seen from its end
                names.append(self._add_axis(d))
        for name, place, out in names:
            self._add_text(name, SMALL, lambda distance, place=place, out=out: place + distance * out, 0.62 if abs(out[0]) > 0.9 else 0.5)

    def _project(self, point):
        return (self.view.project(point)[:2] - self.centre) * self.inches

    def _add_axis(self, d):
        """Adds an axis without its name; returns that, where it belongs, and the direction away from the body."""
        along = unit(self.view.project(np.eye(3)[d])[:2])
        upright = abs(along[1]) > 0.9
        out = np.array([along[1], -along[0]])
        if (out[0] if upright else out[1]) > 0:
            out = -out  # downwards, or to the left
        corners = np.array(np.meshgrid(*zip(self.low, self.high))).reshape(3, -1).T
        start = max(corners[corners[:, d] == self.low[d]], key=lambda corner: (self._project(corner) @ out).round(9))

        def place(value, distance):
            return self._project(np.where(np.arange(3) == d, value, start)) + distance * out

        low, high = self.low[d], self.high[d]
        self.lines.append((place(low, 0.1), place(high, 0.1)))
        length = np.linalg.norm(place(high, 0) - place(low, 0))
        for tick in ticker.MaxNLocator(max(1, int(length / 0.5)), steps=[1, 2, 5, 10]).tick_values(low, high):
            if low <= tick <= high and length > 0.3:  # numbers of a shorter one would overlap
                self.lines.append((place(tick, 0.1), place(tick, 0.16)))
                number = f"{round(tick, 12):g}"
                aside = np.array([-0.5 * width_of(number, NUMBER), 0]) if upright else 0
                self._add_text(number, NUMBER, lambda distance, tick=tick, aside=aside: place(tick, distance) + aside,
                               0.2 if upright else 0.27, most=0.3)
        return f"{'xyz'[d]} [{self.unit}]", place(0.5 * (low + high), 0), out

    def _add_text(self, text, points, place, distance, most=2.0):
        """Adds a text at the least distance at which it covers no other; leaves it out beyond the largest one."""
        size = np.array([width_of(text, points) + 0.06, 1.3 * points / 72])
        start = distance
        while any((abs(place(distance) - other) < 0.5 * (size + extent)).all() for _, other, extent, _ in self.texts):
            distance += 0.02
            if distance > start + most:
                return
        self.texts.append((text, place(distance), size, points))

    def pad(self):
        """Inches to the left of and below the panel."""
        low = np.min([place - 0.5 * size for _, place, size, _ in self.texts], axis=0) if self.texts else -self.half
        return np.maximum(-self.half - low + GAP, 0.3)

    def draw(self, axes):
        """Into the panel's axes."""
        to_window = lambda place: self.centre + np.asarray(place) / self.inches  # noqa: E731
        left, bottom = self.centre - self.half / self.inches
        right, top = self.centre + self.half / self.inches
        axes.set(xlim=(left, right), ylim=(bottom, top))
        axes.set_axis_off()
        for ends in self.lines:
            axes.plot(*to_window(ends).T, color="0.35", linewidth=0.8, clip_on=False, zorder=1)
        for text, place, _, points in self.texts:
            axes.text(*to_window(place), text, fontsize=points, color="0.25" if points == NUMBER else "0", ha="center", va="center")


def write(path, picture):
    """Replaces the file at once: an older picture stays if that fails."""
    temporary = path + ".part"
    try:
        with open(temporary, "wb") as file:
            file.write(picture)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise PictureError(f'cannot write "{path}": {error.strerror}') from None
