# SPDX-License-Identifier: BSD-3-Clause
"""Fields of a deck: one expression as muParser's text and as a Python function, in base units of a scene."""
import math


class Field:
    """A scalar over base coordinates. `text` has X, Y, Z for them; `function(x, y, z)` is its value."""

    def __init__(self, text, function):
        self.text, self.function = text, function

    def __call__(self, x, y=0.0, z=0.0):
        return self.function(x, y, z)

    def __mul__(self, factor):
        return Field(f"{factor!r}*({self.text})", lambda x, y, z: factor * self.function(x, y, z))

    def __add__(self, other):
        return Field(f"({self.text}) + ({other.text})", lambda x, y, z: self.function(x, y, z) + other.function(x, y, z))

    def deck(self, length, unit):
        """The expression in the deck's units: coordinates by length, values by unit."""
        text = self.text
        for name in "XYZ":
            text = text.replace(name, name.lower() if length == 1 else f"({name.lower()}/{length!r})")
        return text if unit == 1 else f"{unit!r}*({text})"


class Constant(Field):
    def __init__(self, value):
        super().__init__(repr(value), lambda x, y, z: value)
        self.value = value

    def __mul__(self, factor):
        return Constant(self.value * factor)

    def deck(self, length, unit):
        return repr(self.value * unit)


INFINITE = Constant(math.inf)


class InTime(Field):
    """A field times a factor of time: 0 at t = 0, factors[k - 1] at t = k, straight in between."""

    def __init__(self, field, factors):
        self.field, self.factors = field, factors
        super().__init__(f"({field.text})*({ramp(factors)})", None)

    def at(self, time):
        return self.field * factor_at(self.factors, time)


def ramp(factors):
    """The expression of t for such factors."""
    return " + ".join(f"({value!r})*max(0, 1 - abs(t - {k}))" for k, value in enumerate(factors, 1))


def factor_at(factors, time):
    return sum(value * max(0.0, 1 - abs(time - k)) for k, value in enumerate(factors, 1))


def linear(at_zero, slope):
    return Field(f"{at_zero!r} + ({slope!r})*X", lambda x, y, z: at_zero + slope * x)


def sine(mean, amplitude, waves, phase=0.0):
    """waves: per unit of length."""
    return Field(f"{mean!r} + ({amplitude!r})*sin(2*pi*({waves!r})*X + {phase!r})",
                 lambda x, y, z: mean + amplitude * math.sin(2 * math.pi * waves * x + phase))


def bump(amplitude, centre, width):
    return Field(f"({amplitude!r})*exp(-((X - {centre!r})/{width!r})^2)",
                 lambda x, y, z: amplitude * math.exp(-(((x - centre) / width) ** 2)))


def exponential(first, last, extent):
    """From first at X = 0 to last at X = extent, both > 0."""
    rate = math.log(last / first) / extent
    return Field(f"{first!r}*exp(({rate!r})*X)", lambda x, y, z: first * math.exp(rate * x))


def step(at, before, after):
    return Field(f"(X < {at!r} ? {before!r} : {after!r})", lambda x, y, z: before if x < at else after)


def stairs(height, width):
    """0, height, 0, height, ... in pieces of a width."""
    return Field(f"(sin(pi*X/{width!r}) < 0 ? {height!r} : 0)",
                 lambda x, y, z: height if math.sin(math.pi * x / width) < 0 else 0.0)


def oscillation(low, high, waves):
    """Between low and high > 0, even in the logarithm."""
    middle, swing = math.log(low * high) / 2, math.log(high / low) / 2
    return Field(f"exp({middle!r} + ({swing!r})*cos(2*pi*({waves!r})*X))",
                 lambda x, y, z: math.exp(middle + swing * math.cos(2 * math.pi * waves * x)))


def parabola(curvature, at, lowest=0.0):
    return Field(f"{lowest!r} + {curvature!r}*(X - {at!r})^2", lambda x, y, z: lowest + curvature * (x - at) ** 2)


HEIGHT = Field("Y", lambda x, y, z: y)


def paraboloid(curvature, at_x, at_z):
    return Field(f"{curvature!r}*((X - {at_x!r})^2 + (Z - {at_z!r})^2)", lambda x, y, z: curvature * ((x - at_x) ** 2 + (z - at_z) ** 2))


def egg_box(amplitude, waves_x, waves_z, phase):
    """waves: per unit of length."""
    return Field(f"({amplitude!r})*sin(2*pi*({waves_x!r})*X + {phase!r})*cos(2*pi*({waves_z!r})*Z)",
                 lambda x, y, z: amplitude * math.sin(2 * math.pi * waves_x * x + phase) * math.cos(2 * math.pi * waves_z * z))


def noise(amplitude, key):
    """In [-amplitude, amplitude], without relation from one point to the next; key, about 10, chooses the noise."""
    def function(x, y, z):
        t = 43758.5453 * math.sin(key * x + 7.1093 * y + 78.233 * z)
        return 2 * amplitude * (t - round(t))
    t = f"43758.5453*sin({key!r}*X + 7.1093*Y + 78.233*Z)"
    return Field(f"{2 * amplitude!r}*({t} - rint({t}))", function)
