"""Fields of a deck: one expression as muParser's text and as a Python function, in base units of a scene."""
import math


class Field:
    """A scalar over base coordinates. `text` has X, Y, Z for them; `function(x, y)` is its value."""

    def __init__(self, text, function):
        self.text, self.function = text, function

    def __call__(self, x, y=0.0):
        return self.function(x, y)

    def __mul__(self, factor):
        return Field(f"{factor!r}*({self.text})", lambda x, y: factor * self.function(x, y))

    def __add__(self, other):
        return Field(f"({self.text}) + ({other.text})", lambda x, y: self.function(x, y) + other.function(x, y))

    def deck(self, length, unit):
        """The expression in the deck's units: coordinates by length, values by unit."""
        text = self.text
        for name in "XYZ":
            text = text.replace(name, name.lower() if length == 1 else f"({name.lower()}/{length!r})")
        return text if unit == 1 else f"{unit!r}*({text})"


class Constant(Field):
    def __init__(self, value):
        super().__init__(repr(value), lambda x, y: value)
        self.value = value

    def __mul__(self, factor):
        return Constant(self.value * factor)

    def deck(self, length, unit):
        return repr(self.value * unit)


INFINITE = Constant(math.inf)


def linear(at_zero, slope):
    return Field(f"{at_zero!r} + ({slope!r})*X", lambda x, y: at_zero + slope * x)


def sine(mean, amplitude, waves, phase=0.0):
    """waves: per unit of length."""
    return Field(f"{mean!r} + ({amplitude!r})*sin(2*pi*({waves!r})*X + {phase!r})",
                 lambda x, y: mean + amplitude * math.sin(2 * math.pi * waves * x + phase))


def bump(amplitude, centre, width):
    return Field(f"({amplitude!r})*exp(-((X - {centre!r})/{width!r})^2)",
                 lambda x, y: amplitude * math.exp(-(((x - centre) / width) ** 2)))


def exponential(first, last, extent):
    """From first at X = 0 to last at X = extent, both > 0."""
    rate = math.log(last / first) / extent
    return Field(f"{first!r}*exp(({rate!r})*X)", lambda x, y: first * math.exp(rate * x))


def step(at, before, after):
    return Field(f"(X < {at!r} ? {before!r} : {after!r})", lambda x, y: before if x < at else after)


def stairs(height, width):
    """0, height, 0, height, ... in pieces of a width."""
    return Field(f"(sin(pi*X/{width!r}) < 0 ? {height!r} : 0)",
                 lambda x, y: height if math.sin(math.pi * x / width) < 0 else 0.0)


def oscillation(low, high, waves):
    """Between low and high > 0, even in the logarithm."""
    middle, swing = math.log(low * high) / 2, math.log(high / low) / 2
    return Field(f"exp({middle!r} + ({swing!r})*cos(2*pi*({waves!r})*X))",
                 lambda x, y: math.exp(middle + swing * math.cos(2 * math.pi * waves * x)))


def parabola(curvature, at, lowest=0.0):
    return Field(f"{lowest!r} + {curvature!r}*(X - {at!r})^2", lambda x, y: lowest + curvature * (x - at) ** 2)
