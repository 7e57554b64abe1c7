# SPDX-License-Identifier: BSD-3-Clause
"""Reads what rpc writes with the Exodus library, without it."""

import math
import struct


class Film:
    """Times and nodal variables of an Exodus file: NetCDF in its classic format, read by the manual."""

    def __init__(self, path):
        self.bytes, self.at = path.read_bytes(), 4
        assert self.bytes[:3] == b"CDF" and self.bytes[3] in (1, 2, 5)
        self.count, self.offset = (">Q" if self.bytes[3] == 5 else ">I"), (">I" if self.bytes[3] == 1 else ">Q")
        records = self._number()
        dimensions = self._entries(lambda: (self._name(), self._number()))
        self._entries(self._attribute)
        variables = dict(self._entries(self._variable))
        sizes = [size for _, size in dimensions]
        inner = lambda of: math.prod(size for size in (sizes[d] for d in of) if size > 0)
        width = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8}
        moving = {n: v for n, v in variables.items() if v[0] and sizes[v[0][0]] == 0}
        stride = sum(-(-inner(of) * width[kind] // 4) * 4 for of, kind, _ in moving.values())
        doubles = lambda at, n: list(struct.unpack_from(f">{n}d", self.bytes, at))
        self.times = [doubles(variables["time_whole"][2] + k * stride, 1)[0] for k in range(records)]
        of, _, at = variables["name_nod_var"]
        length = sizes[of[1]]
        names = [self.bytes[at + k * length:at + (k + 1) * length].split(b"\0")[0].decode().strip() for k in range(sizes[of[0]])]
        self.nodal = {}
        for k, name in enumerate(names, 1):
            of, _, at = variables[f"vals_nod_var{k}"]
            self.nodal[name] = [doubles(at + r * stride, inner(of)) for r in range(records)]

    def _take(self, form):
        value, = struct.unpack_from(form, self.bytes, self.at)
        self.at += struct.calcsize(form)
        return value

    def _number(self):
        return self._take(self.count)

    def _name(self):
        size = self._number()
        name = self.bytes[self.at:self.at + size].decode()
        self.at += -(-size // 4) * 4
        return name

    def _entries(self, read):
        self._take(">I")
        return [read() for _ in range(self._number())]

    def _attribute(self):
        self._name()
        width = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8}[self._take(">I")]
        size = self._number() * width
        self.at += -(-size // 4) * 4

    def _variable(self):
        name = self._name()
        of = [self._number() for _ in range(self._number())]
        self._entries(self._attribute)
        kind = self._take(">I")
        self._number()
        return name, (of, kind, self._take(self.offset))
