"""The picture: body, foundation, axes, colour bars, title."""
import io
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import cm, collections, colors, lines, patches, ticker  # noqa: E402

import view  # noqa: E402
from result import PictureError  # noqa: E402
from scene import largest_gap  # noqa: E402
from surface import PLACE, VALUE, unit  # noqa: E402

DPI = 140
LARGEST = (9.0, 6.0)  # inches of a panel in the plane
PANEL = (5.4, 5.0)  # in space
STATES = ["open", "closed", "yielding"]
REST = {"color": "0.45", "linewidth": 0.8}  # outline of the undeformed body
MARGIN = 0.03  # around what is drawn, of its size


def label(name):
    """What a colour bar says of a field."""
    axes = name.rsplit("_", 1)[-1]
    known = {
        "contact_pressure": "contact pressure [Pa]", "von_mises": "von Mises stress [Pa]", "gap": "gap [m]", "dent": "dent [m]",
        "penetration": "penetration [m]", "contact_status": "contact status",
    }
    if name in known:
        return known[name]
    if name.startswith("disp_"):
        return f"displacement in {axes} [m]"
    if name.startswith("stress_"):
        return rf"stress $\sigma_{{{axes}}}$ [Pa]"
    return name.replace("_", " ")


def coloring(name, values, contact):
    """(norm, colour map) of a field with these values."""
    values = values[np.isfinite(values)]
    if name == "contact_status":
        return colors.BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3), colors.ListedColormap(["#d9d9d9", "#4292c6", "#cb181d"])
    low, high = (values.min(), values.max()) if len(values) else (0.0, 1.0)
    if name in ("contact_pressure", "von_mises", "dent", "penetration"):
        low, high = 0.0, max(high, 0.0)
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
    return {layer: coloring(field, scene.layers[layer][..., VALUE], layer == "contact") for layer, field in fields_of(scene).items()}


def upwards(scene):
    """The axis of space that leads away from the foundation; z without one."""
    main = abs(scene.normal).argmax() if abs(scene.normal).max() > 0.5 else 2
    up = np.zeros(3)
    up[main] = -1 if scene.normal[main] > 0.5 else 1
    return up


def towards(scene, up):
    """Direction to the viewer, level: of four, or two that see into the cut, the one from which most stress is seen."""
    first, second = (np.eye(3)[(abs(up).argmax() + k) % 3] for k in (1, 2))
    candidates = [a * first + b * second for a, b in ((0.8, -0.6), (-0.8, -0.6), (0.8, 0.6), (-0.8, 0.6))]
    if scene.cut:
        out = scene.cut.towards * np.eye(3)[scene.cut.axis]
        candidates = [c for c in candidates if c @ out > 0] or candidates
    rows = scene.layers["body"]
    sides = np.cross(rows[:, 1, PLACE] - rows[:, 0, PLACE], rows[:, 2, PLACE] - rows[:, 0, PLACE])
    seen = [(np.clip(sides @ c, 0, None) * abs(np.nan_to_num(rows[..., VALUE].mean(axis=1)))).sum() for c in candidates]
    return candidates[next(k for k, amount in enumerate(seen) if amount >= 0.98 * max(seen))]


def panels(scene, direction):
    """[(view, caption, layers left out)]: one panel, two if the contact side in space is to be seen."""
    if scene.result.dim == 2:
        return [(view.FRONT, "", ())]
    up = upwards(scene)
    level = towards(scene, up)
    if direction is not None:
        return [(view.view_from(direction, up), "", ())]
    above = view.view_from(level + 0.45 * up, up)
    if not scene.contact_field or "foundation" not in scene.layers:
        return [(above, "", ())]
    return [(above, "on the foundation", ()), (view.view_from(level - 0.7 * up, -up), "turned over", ("foundation",))]


def draw(scene, direction=None):
    """The picture as the bytes of a PNG.

    @param direction  in space, from the body to the viewer; None: chosen
    """
    flat = scene.result.dim == 2
    shown = panels(scene, direction)
    windows = [grown(window, MARGIN) for window in view.bounds(scene, [panel[0] for panel in shown])]
    size = [max(window[2 * d + 1] - window[2 * d] for window in windows) for d in (0, 1)]  # [m]
    inches = min(most / length for most, length in zip(LARGEST if flat else PANEL, size))
    width, height = (length * inches for length in size)
    pad = (0.85, 0.6) if flat else (0.85, 0.5)  # left of and below a panel, for axes
    fields = fields_of(scene)
    bar_height = max(height, 1.9)
    below, above = pad[1] + 0.35, 0.45 if flat else 0.75
    total = (len(shown) * (width + pad[0]) + 0.35 + 1.15 * len(fields) + 0.15, below + bar_height + above)
    figure = plt.figure(figsize=total, dpi=DPI)

    def place(left, bottom, wide, high):
        return figure.add_axes([left / total[0], bottom / total[1], wide / total[0], high / total[1]])

    chosen = colorings(scene)
    bottom = below + 0.5 * (bar_height - height)
    for k, ((eye, caption, without), window) in enumerate(zip(shown, windows)):
        window = widened(window, size)
        axes = place(pad[0] + k * (width + pad[0]), bottom, width, height)
        image = view.paint(scene, eye, window, inches * DPI, chosen, without)
        axes.imshow(image, extent=window, origin="lower", interpolation="none", zorder=2, aspect="auto")
        if flat:
            add_axes_of_plane(axes, scene, window)
        else:
            axes.set(xlim=window[:2], ylim=window[2:])
            axes.set_axis_off()
            add_axes_of_space(axes, scene, eye, without, 1 / inches)
            axes.set_title(caption, fontsize=10, color="0.3")
    left = len(shown) * (width + pad[0]) + 0.35
    for k, (name, field) in enumerate(fields.items()):
        add_color_bar(place(left + 1.15 * k, below + 0.08 * bar_height, 0.16, 0.84 * bar_height), field, *chosen[name])
    figure.text(0.5, 1 - 0.2 / total[1], title(scene), ha="center", va="center", fontsize=12)
    add_legend(figure, scene)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=DPI)
    plt.close(figure)
    return file.getvalue()


def draw_plane(axes, scene, resolution=1000):
    """Draws a body in the plane into axes of another figure.

    @param resolution  pixels that the longer side gets
    @return what a colour bar of the body's field takes
    """
    (window,) = view.bounds(scene, [view.FRONT])
    window = grown(window, MARGIN)
    chosen = colorings(scene)
    pixels = resolution / max(window[1] - window[0], window[3] - window[2])
    axes.imshow(view.paint(scene, view.FRONT, window, pixels, chosen), extent=window, origin="lower", zorder=2)
    add_axes_of_plane(axes, scene, window)
    axes.grid(False)
    return cm.ScalarMappable(*chosen["body"])


def add_axes_of_plane(axes, scene, window):
    """Axes with units, and the outline of the undeformed body."""
    axes.add_collection(collections.LineCollection(scene.rest[..., :2], **REST, zorder=3))
    axes.set(xlim=window[:2], ylim=window[2:], xlabel="x [m]", ylabel="y [m]")
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


def title(scene):
    """What is drawn, and how much the displacements are enlarged."""
    result = scene.result
    moved = "displacements"
    if scene.scale > 1 and largest_gap(result) > 1e-9 * result.size():
        moved += " and gaps"
    parts = [result.title[:60], f"{moved} \u00d7 {scene.scale:g}"]
    if result.num_times > 1:
        parts.insert(1, f"t = {result.time:g}")
    if scene.cut:
        parts.append(f"cut at {'xyz'[scene.cut.axis]} = {scene.cut.value:g} m")
    return "    ".join(part for part in parts if part)


def add_color_bar(axes, field, norm, colors_of):
    """A colour bar with its unit."""
    bar = axes.figure.colorbar(cm.ScalarMappable(norm, colors_of), cax=axes)
    bar.set_label(label(field))
    bar.outline.set_linewidth(0.5)
    if field == "contact_status":
        bar.set_ticks([0, 1, 2], labels=STATES, rotation=90, va="center")
        bar.ax.tick_params(length=0)
        return
    bar.formatter.set_powerlimits((-3, 5))
    bar.update_ticks()


def add_legend(figure, scene):
    """Below the panels, what is no field."""
    handles = []
    if scene.rest is not None:
        handles.append(lines.Line2D([], [], **REST, label="undeformed body"))
    if len(scene.layers.get("foundation", ())):
        handles.append(patches.Patch(facecolor=view.GROUND, edgecolor=view.INK, linewidth=0.6, label="foundation"))
    if handles:
        figure.legend(handles=handles, loc="lower center", ncols=len(handles), frameon=False, fontsize=9)


def add_axes_of_space(axes, scene, eye, without, inch):
    """The three edges of the box around all that is drawn that lie at the rim of the picture, with ticks.

    @param inch  of the picture [m]
    """
    points = np.concatenate([rows[..., PLACE].reshape(-1, 3) for name, rows in scene.layers.items() if name not in without])
    low, high = points.min(axis=0), points.max(axis=0)
    for d in range(3):
        along = eye.project(np.eye(3)[d])[:2]
        if np.linalg.norm(along) < 0.1:  # seen from its end
            continue
        along = unit(along)
        upright = abs(along[1]) > 0.9
        out = np.array([along[1], -along[0]])
        if (out[0] if upright else out[1]) > 0:
            out = -out  # downwards, or to the left
        corners = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
        start = max(corners[corners[:, d] == low[d]], key=lambda corner: (eye.project(corner)[:2] @ out).round(9))

        def place(value, distance):
            point = np.where(np.arange(3) == d, value, start)
            return eye.project(point)[:2] + distance * inch * out

        def line(first, last):
            axes.plot(*np.transpose([first, last]), color="0.35", linewidth=0.8, clip_on=False, zorder=1)

        line(place(low[d], 0.1), place(high[d], 0.1))
        length = np.linalg.norm(place(high[d], 0) - place(low[d], 0)) / inch
        for tick in ticker.MaxNLocator(max(1, int(length / 0.5)), steps=[1, 2, 5, 10]).tick_values(low[d], high[d]):
            if low[d] <= tick <= high[d] and length > 0.3:  # numbers of a shorter one would overlap
                line(place(tick, 0.1), place(tick, 0.16))
                axes.text(*place(tick, 0.2 if upright else 0.27), f"{round(tick, 12):g}", fontsize=8, color="0.25",
                          ha="right" if upright else "center", va="center")
        axes.text(*place(0.5 * (low[d] + high[d]), 0.62 if upright else 0.5), f"{'xyz'[d]} [m]", ha="center", va="center",
                  fontsize=9)


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
