"""The compiled kernel that carries out programs (:mod:`shapewright.modeling.program`), eight instances at a time.

Instances go through a program in blocks of ``WIDTH``: a row of the state is three values x, y, z of the type ``Lanes``,
each of which holds one number of every instance of the block and becomes a vector register or two. What is written
below for one instance is thereby done for eight. An instance does not depend on the others of its block: all lanes do
the same arithmetic in the same order, so a batch equals one by one to the last bit.

All kernels and the type stand in this one file on purpose: numba's cache looks at the date of the file in which a
kernel stands, not at those of what it calls.
"""

import math
import operator
from typing import Any, Final, no_type_check

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core.cgutils import get_or_insert_function
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

from shapewright.modeling import opcodes

WIDTH: Final = 8
"""Instances of a block."""
_ROW: Final = 3 * WIDTH

_TINY: Final = 1e-12
_FLAT: Final = 1e-9

# ---------------------------------------------------------------------- the type


class Lanes(types.Type):
    """One number for each instance of a block."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


_LANES = Lanes()
_VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
_FIRST = ir.Constant(ir.IntType(32), 0)


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Lanes) -> None:
        super().__init__(manager, kind, _VECTOR)  # type: ignore[no-untyped-call]


@no_type_check
def _everywhere(builder, number):
    one = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, _FIRST)
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(one, ir.Constant(_VECTOR, ir.Undefined), zeros)


@no_type_check
def _address(context, builder, kind, array, index):
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


@intrinsic
@no_type_check
def _load(typing, array, index):
    """Return the lanes at ``array[index:]``."""

    def code(context, builder, signature, arguments):
        return builder.load(_address(context, builder, signature.args[0], *arguments), align=8)

    return _LANES(array, types.intp), code


@intrinsic
@no_type_check
def _store(typing, array, index, value):
    """Write lanes to ``array[index:]``."""

    def code(context, builder, signature, arguments):
        address = _address(context, builder, signature.args[0], *arguments[:2])
        builder.store(arguments[2], address, align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, _LANES), code


@intrinsic
@no_type_check
def _lanes(typing, number):
    """Return a number for every instance."""

    def code(context, builder, signature, arguments):
        return _everywhere(builder, arguments[0])

    return _LANES(types.float64), code


@intrinsic
@no_type_check
def _root(typing, value):
    """Return the square roots."""

    def code(context, builder, signature, arguments):
        kind = ir.FunctionType(_VECTOR, [_VECTOR])
        function = get_or_insert_function(builder.module, kind, f"llvm.sqrt.v{WIDTH}f64")
        return builder.call(function, arguments)

    return _LANES(_LANES), code


@no_type_check
def _choice(predicate):
    @intrinsic
    @no_type_check
    def choose(typing, first, second, yes, no):
        def code(context, builder, signature, arguments):
            first, second, yes, no = arguments
            return builder.select(builder.fcmp_ordered(predicate, first, second), yes, no)

        return _LANES(_LANES, _LANES, _LANES, _LANES), code

    return choose


_where_at_most = _choice("<=")
"""(a, b, yes, no) -> yes where a <= b, no elsewhere."""
_where_equal = _choice("==")
_where_less = _choice("<")


@no_type_check
def _define(operation, instruction):
    infer_global(operation)(
        type(
            "LanesTemplate",
            (ConcreteTemplate,),
            {
                "cases": [
                    signature(_LANES, _LANES, _LANES),
                    signature(_LANES, _LANES, types.float64),
                    signature(_LANES, types.float64, _LANES),
                ]
            },
        )
    )

    def code(context, builder, signature, arguments):
        both = [
            value if kind == _LANES else _everywhere(builder, value)
            for value, kind in zip(arguments, signature.args, strict=True)
        ]
        return getattr(builder, instruction)(*both)

    for kinds in ((_LANES, _LANES), (_LANES, types.Float), (types.Float, _LANES)):
        lower_builtin(operation, *kinds)(code)


_define(operator.add, "fadd")
_define(operator.sub, "fsub")
_define(operator.mul, "fmul")
_define(operator.truediv, "fdiv")


@no_type_check
def _compiled(function: Any) -> Any:
    return njit(cache=True, nogil=True, error_model="numpy")(function)


@_compiled
@no_type_check
def _aligned(size):
    """Return a new array that begins where a cache line does, so that no lanes lie across two lines."""
    array = np.empty(size + WIDTH)
    skipped = (-(array.ctypes.data // 8)) % WIDTH
    return array[skipped : skipped + size]


# ---------------------------------------------------------------------- points and frames


@_compiled
@no_type_check
def _point(state, row):
    at = row * _ROW
    return _load(state, at), _load(state, at + WIDTH), _load(state, at + 2 * WIDTH)


@_compiled
@no_type_check
def _put(state, row, x, y, z):
    at = row * _ROW
    _store(state, at, x)
    _store(state, at + WIDTH, y)
    _store(state, at + 2 * WIDTH, z)


@_compiled
@no_type_check
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@_compiled
@no_type_check
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@_compiled
@no_type_check
def _minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@_compiled
@no_type_check
def _unit(a, smallest, fallback_z):
    """Return the unit vector, or (0, 0, fallback_z) where it is not longer than ``smallest``."""
    length = _root(_dot(a, a))
    one, zero = _lanes(1.0), _lanes(0.0)
    divisor = _where_at_most(length, smallest, one, length)
    return (
        _where_at_most(length, smallest, zero, a[0] / divisor),
        _where_at_most(length, smallest, zero, a[1] / divisor),
        _where_at_most(length, smallest, _lanes(fallback_z), a[2] / divisor),
    )


@_compiled
@no_type_check
def _largest(a, b):
    return _where_less(a, b, b, a)


@_compiled
@no_type_check
def _magnitude(a):
    return _where_less(a, _lanes(0.0), _lanes(0.0) - a, a)


@_compiled
@no_type_check
def _across(normal):
    """Return a direction that is surely not along the normal, made perpendicular to it."""
    x, y, z = _magnitude(normal[0]), _magnitude(normal[1]), _magnitude(normal[2])
    one, zero = _lanes(1.0), _lanes(0.0)
    along_x = _where_at_most(x, y, _where_at_most(x, z, one, zero), zero)
    along_y = (1.0 - along_x) * _where_at_most(y, z, one, zero)
    axis = along_x, along_y, 1.0 - along_x - along_y
    share = _dot(axis, normal)
    return axis[0] - share * normal[0], axis[1] - share * normal[1], axis[2] - share * normal[2]


@_compiled
@no_type_check
def _loop_normal(state, code, first, count):
    """Return the area vector of a face, and the least length at which it has a direction.

    That is relative to the face's size, so that a model may be as small as it likes; a collapsed face has no say.
    """
    centre = _point(state, code[first])
    zero = _lanes(0.0)
    x, y, z, extent = zero, zero, zero, zero
    spoke = zero, zero, zero
    for i in range(1, count):
        following = _minus(_point(state, code[first + i]), centre)
        area = _cross(spoke, following)
        x, y, z = x + area[0], y + area[1], z + area[2]
        extent = _largest(extent, _dot(following, following))
        spoke = following
    return (x, y, z), _largest(_FLAT * extent, _lanes(_TINY * _TINY))


@_compiled
@no_type_check
def _frame(state, code, numbers, sources, targets):
    """Write u, v and z of a face, an edge or a vertex (:mod:`shapewright.modeling.frames`)."""
    n_loops = code[numbers]
    at = sources + 2
    if n_loops == 1:
        area, smallest = _loop_normal(state, code, at, code[numbers + 1])
    else:
        x, y, z = _lanes(0.0), _lanes(0.0), _lanes(0.0)
        for i in range(n_loops):
            count = code[numbers + 1 + i]
            one, least = _loop_normal(state, code, at, count)
            one = _unit(one, least, 0.0)
            x, y, z = x + one[0], y + one[1], z + one[2]
            at += count
        area, smallest = (x, y, z), _lanes(_TINY)
    normal = _unit(area, smallest, 1.0)
    along = _minus(_point(state, code[sources + 1]), _point(state, code[sources]))
    share = _dot(along, normal)
    u = along[0] - share * normal[0], along[1] - share * normal[1], along[2] - share * normal[2]
    floor = _TINY * _largest(_dot(along, along), _lanes(_TINY * _TINY))
    square, other = _dot(u, u), _across(normal)
    u = (
        _where_at_most(square, floor, other[0], u[0]),
        _where_at_most(square, floor, other[1], u[1]),
        _where_at_most(square, floor, other[2], u[2]),
    )
    length = _root(_dot(u, u))
    u = u[0] / length, u[1] / length, u[2] / length
    v = _cross(normal, u)
    _put(state, code[targets], u[0], u[1], u[2])
    _put(state, code[targets + 1], v[0], v[1], v[2])
    _put(state, code[targets + 2], normal[0], normal[1], normal[2])


@_compiled
@no_type_check
def _mean(state, code, first, end):
    x, y, z = _lanes(0.0), _lanes(0.0), _lanes(0.0)
    for i in range(first, end):
        point = _point(state, code[i])
        x, y, z = x + point[0], y + point[1], z + point[2]
    count = float(end - first)
    return x / count, y / count, z / count


@_compiled
@no_type_check
def _from_local(u, v, z, a, b, c):
    return (
        u[0] * a + v[0] * b + z[0] * c,
        u[1] * a + v[1] * b + z[1] * c,
        u[2] * a + v[2] * b + z[2] * c,
    )


# ---------------------------------------------------------------------- instructions


@_compiled
@no_type_check
def _set(state, code, constants, numbers, targets, end):
    at = code[numbers]
    for i in range(targets, end):
        _put(state, code[i], _lanes(constants[at]), _lanes(constants[at + 1]), _lanes(constants[at + 2]))
        at += 3


@_compiled
@no_type_check
def _image(state, code, constants, numbers, sources, targets):
    at = code[numbers]
    for i in range(3):
        x, y, z = _point(state, code[sources + i])
        _put(
            state,
            code[targets + i],
            constants[at] * x + constants[at + 1] * y + constants[at + 2] * z,
            constants[at + 3] * x + constants[at + 4] * y + constants[at + 5] * z,
            constants[at + 6] * x + constants[at + 7] * y + constants[at + 8] * z,
        )


@_compiled
@no_type_check
def _place(state, code, constants, numbers, sources, targets, end):
    u, v, z = _point(state, code[sources]), _point(state, code[sources + 1]), _point(state, code[sources + 2])
    zero = _lanes(0.0)
    centre = zero, zero, zero
    if targets > sources + 3:
        centre = _point(state, code[sources + 3])
    at = code[numbers]
    for i in range(targets, end):
        point = _from_local(u, v, z, constants[at], constants[at + 1], constants[at + 2])
        _put(state, code[i], point[0] + centre[0], point[1] + centre[1], point[2] + centre[2])
        at += 3


@_compiled
@no_type_check
def _way(state, code, amounts, slot, sources):
    """Return rho cos(phi) u + rho sin(phi) v + z n."""
    u, v, z = _point(state, code[sources]), _point(state, code[sources + 1]), _point(state, code[sources + 2])
    rho = _load(amounts, slot)
    a, b = rho * _load(amounts, slot + 3 * WIDTH), rho * _load(amounts, slot + 4 * WIDTH)
    return _from_local(u, v, z, a, b, _load(amounts, slot + 2 * WIDTH))


@_compiled
@no_type_check
def _lift(state, code, way, first, targets, end):
    """Put the targets where the way leads from the rows that begin at ``first``."""
    for i in range(end - targets):
        x, y, z = _point(state, code[first + i])
        _put(state, code[targets + i], x + way[0], y + way[1], z + way[2])


@_compiled
@no_type_check
def _bend(state, code, constants, amounts, slot, numbers, sources, targets, end):
    u, v, z = _point(state, code[sources]), _point(state, code[sources + 1]), _point(state, code[sources + 2])
    centre = _point(state, code[sources + 3])
    width, length = _load(amounts, slot), _load(amounts, slot + WIDTH)
    at = code[numbers]
    x_way, y_way, z_way = constants[at + 9] * length, constants[at + 10] * length, constants[at + 11] * length
    for i in range(end - targets):
        offset = _minus(_point(state, code[sources + 4 + i]), centre)
        x, y, up = _dot(u, offset), _dot(v, offset) * width, _dot(z, offset)
        point = _from_local(
            u,
            v,
            z,
            constants[at] * x + constants[at + 1] * y + constants[at + 2] * up + x_way,
            constants[at + 3] * x + constants[at + 4] * y + constants[at + 5] * up + y_way,
            constants[at + 6] * x + constants[at + 7] * y + constants[at + 8] * up + z_way,
        )
        _put(state, code[targets + i], centre[0] + point[0], centre[1] + point[1], centre[2] + point[2])


@_compiled
@no_type_check
def _insert(state, code, amounts, slot, sources, targets):
    share = _load(amounts, slot)
    start, end = _point(state, code[sources]), _point(state, code[sources + 1])
    rest = 1.0 - share
    _put(
        state,
        code[targets],
        share * start[0] + rest * end[0],
        share * start[1] + rest * end[1],
        share * start[2] + rest * end[2],
    )


@_compiled
@no_type_check
def _all_are(amounts, slot, neutral):
    same = True
    for lane in range(WIDTH):
        same &= amounts[slot + lane] == neutral
    return same


@_compiled
@no_type_check
def _stretch(state, code, amounts, slot, numbers, sources, targets, end):
    if _all_are(amounts, slot, 1.0):  # many proportions are inserted at 1 and stay there
        return
    sigma, one = _load(amounts, slot), _lanes(1.0)
    for axis in range(3):
        if code[numbers + axis] == 0:
            continue
        pivot = _load(state, code[sources] * _ROW + axis * WIDTH)
        for i in range(targets, end):
            at = code[i] * _ROW + axis * WIDTH
            x = _load(state, at)
            _store(state, at, _where_equal(sigma, one, x, pivot + (x - pivot) * sigma))


@_compiled
@no_type_check
def _map(state, code, a, b, c, neutral, amount, pivot, targets, end):
    """Apply the matrix with the rows a, b, c about the pivot, except where the amount is neutral."""
    for i in range(targets, end):
        point = _point(state, code[i])
        offset = _minus(point, pivot)
        _put(
            state,
            code[i],
            _where_equal(amount, neutral, point[0], pivot[0] + _dot(a, offset)),
            _where_equal(amount, neutral, point[1], pivot[1] + _dot(b, offset)),
            _where_equal(amount, neutral, point[2], pivot[2] + _dot(c, offset)),
        )


@_compiled
@no_type_check
def _scale(state, code, amounts, slot, numbers, sources, targets, end):
    if _all_are(amounts, slot, 1.0):
        return
    sigma, one = _load(amounts, slot), _lanes(1.0)
    u, v, z = _point(state, code[sources + 1]), _point(state, code[sources + 2]), _point(state, code[sources + 3])
    along_u = sigma if code[numbers] == 1 else one
    along_v = sigma if code[numbers + 1] == 1 else one
    along_z = sigma if code[numbers + 2] == 1 else one
    us = u[0] * along_u, u[1] * along_u, u[2] * along_u
    vs = v[0] * along_v, v[1] * along_v, v[2] * along_v
    zs = z[0] * along_z, z[1] * along_z, z[2] * along_z
    xy, xz, yz = (
        us[0] * u[1] + vs[0] * v[1] + zs[0] * z[1],
        us[0] * u[2] + vs[0] * v[2] + zs[0] * z[2],
        us[1] * u[2] + vs[1] * v[2] + zs[1] * z[2],
    )
    a = us[0] * u[0] + vs[0] * v[0] + zs[0] * z[0], xy, xz
    b = xy, us[1] * u[1] + vs[1] * v[1] + zs[1] * z[1], yz
    c = xz, yz, us[2] * u[2] + vs[2] * v[2] + zs[2] * z[2]
    _map(state, code, a, b, c, one, sigma, _point(state, code[sources]), targets, end)


@_compiled
@no_type_check
def _rotate(state, code, amounts, slot, numbers, sources, targets, end):
    if _all_are(amounts, slot, 0.0):
        return
    alpha, cosine, sine = _load(amounts, slot), _load(amounts, slot + WIDTH), _load(amounts, slot + 2 * WIDTH)
    axis = code[numbers]
    n = _point(state, code[sources + 1 + axis])
    f = _point(state, code[sources + 1 + (axis + 1) % 3])
    s = _point(state, code[sources + 1 + (axis + 2) % 3])
    g = cosine * f[0] + sine * s[0], cosine * f[1] + sine * s[1], cosine * f[2] + sine * s[2]  # where f turns to
    t = cosine * s[0] - sine * f[0], cosine * s[1] - sine * f[1], cosine * s[2] - sine * f[2]
    a = _from_local(n, f, s, n[0], g[0], t[0])
    b = _from_local(n, f, s, n[1], g[1], t[1])
    c = _from_local(n, f, s, n[2], g[2], t[2])
    _map(state, code, a, b, c, _lanes(0.0), alpha, _point(state, code[sources]), targets, end)


@_compiled
@no_type_check
def _collapse(state, code, there, numbers, sources, targets, end):
    part = code[numbers] * WIDTH
    if _all_are(there, part, 1.0):
        return
    stays, one = _load(there, part), _lanes(1.0)
    to = _point(state, code[sources])
    for i in range(targets, end):
        x, y, z = _point(state, code[i])
        _put(
            state,
            code[i],
            _where_equal(stays, one, x, to[0]),
            _where_equal(stays, one, y, to[1]),
            _where_equal(stays, one, z, to[2]),
        )


@_compiled
@no_type_check
def _carry_out(state, code, constants, amounts, there, parts):
    """Carry out a program on the state of a block whose instances have, taken together, these parts."""
    at = 0
    while at < code.shape[0]:
        operation, end, slot = code[at], at + code[at + 1], code[at + 3] * WIDTH
        numbers = at + opcodes.HEADER
        sources = numbers + code[at + 4]
        targets = sources + code[at + 5]
        needed = code[at + 2] & parts
        at = end
        if needed == 0:
            continue
        if operation == opcodes.STRETCH:
            _stretch(state, code, amounts, slot, numbers, sources, targets, end)
        elif operation == opcodes.CENTRE:
            x, y, z = _mean(state, code, sources, targets)
            _put(state, code[targets], x, y, z)
        elif operation == opcodes.FRAME:
            _frame(state, code, numbers, sources, targets)
        elif operation == opcodes.IMAGE:
            _image(state, code, constants, numbers, sources, targets)
        elif operation == opcodes.SCALE:
            _scale(state, code, amounts, slot, numbers, sources, targets, end)
        elif operation == opcodes.ROTATE:
            _rotate(state, code, amounts, slot, numbers, sources, targets, end)
        elif operation == opcodes.DRAG:
            _lift(state, code, _way(state, code, amounts, slot, sources), targets, targets, end)
        elif operation == opcodes.EXTRUDE:
            _lift(state, code, _way(state, code, amounts, slot, sources), sources + 3, targets, end)
        elif operation == opcodes.PLACE:
            _place(state, code, constants, numbers, sources, targets, end)
        elif operation == opcodes.INSERT:
            _insert(state, code, amounts, slot, sources, targets)
        elif operation == opcodes.BEND:
            _bend(state, code, constants, amounts, slot, numbers, sources, targets, end)
        elif operation == opcodes.COLLAPSE:
            _collapse(state, code, there, numbers, sources, targets, end)
        else:
            _set(state, code, constants, numbers, targets, end)


# ---------------------------------------------------------------------- batches


@_compiled
@no_type_check
def fill_slots(amounts, slots, changes, angles, values, first):
    """Write what the slots hold for the instances of a block."""
    last = values.shape[0] - 1
    for h in range(changes.shape[0]):
        _store(amounts, changes[h, 1] * WIDTH, _lanes(slots[changes[h, 1]]))
    for h in range(changes.shape[0]):
        how, at, column = changes[h, 0], changes[h, 1] * WIDTH, changes[h, 2]
        for lane in range(WIDTH):
            x, q = values[min(first + lane, last), column], amounts[at + lane]
            if how == opcodes.MULTIPLY:
                q = q * x
            elif how == opcodes.HALF_TURNS:
                q = q + 180.0 * (x - 1.0)
            else:
                q = x * q if q < 0.5 else 1.0 - (2.0 - x) * (1.0 - q)
            amounts[at + lane] = q
    for a in range(angles.shape[0]):
        at, cosines = angles[a, 0] * WIDTH, angles[a, 1] * WIDTH
        for lane in range(WIDTH):
            angle_rad = amounts[at + lane] * (math.pi / 180.0)
            amounts[cosines + lane] = math.cos(angle_rad)
            amounts[cosines + WIDTH + lane] = math.sin(angle_rad)


@_compiled
@no_type_check
def _parts_of_block(there, present, first):
    """Write which instances of a block have which part, as 0 or 1; return the guard bits of those that any has."""
    last = present.shape[0] - 1
    parts = np.int64(1) << opcodes.ALWAYS_BIT
    for part in range(present.shape[1]):
        for lane in range(WIDTH):
            has = present[min(first + lane, last), part]
            there[part * WIDTH + lane] = 1.0 if has else 0.0
            if has and part < opcodes.ALWAYS_BIT:
                parts |= np.int64(1) << part
    return parts


@_compiled
@no_type_check
def run(start, code, constants, slots, changes, angles, wanted, values, present, points):
    """Carry out a program for each row of values, and write the wanted rows of the state.

    ``start`` (R, 3), ``code`` (C,), ``constants`` (K,), ``slots`` (S,), ``changes`` (H, 3), ``angles`` (A, 2),
    ``wanted`` (V,), ``values`` (B, P), ``present`` (B, N) -> ``points`` (B, V, 3). Lanes without an instance, in the
    last block, repeat the last one.
    """
    state = _aligned(start.shape[0] * _ROW)
    amounts = _aligned(slots.shape[0] * WIDTH)
    there = _aligned(present.shape[1] * WIDTH)
    for slot in range(slots.shape[0]):
        _store(amounts, slot * WIDTH, _lanes(slots[slot]))
    for first in range(0, values.shape[0], WIDTH):
        for row in range(start.shape[0]):
            _put(state, row, _lanes(start[row, 0]), _lanes(start[row, 1]), _lanes(start[row, 2]))
        fill_slots(amounts, slots, changes, angles, values, first)
        parts = _parts_of_block(there, present, first)
        _carry_out(state, code, constants, amounts, there, parts)
        count = min(WIDTH, values.shape[0] - first)
        for i in range(wanted.shape[0]):
            for axis in range(3):
                at = wanted[i] * _ROW + axis * WIDTH
                for lane in range(count):
                    points[first + lane, i, axis] = state[at + lane]


@_compiled
@no_type_check
def multiply(starts, columns, weights, points, products):
    """Multiply a sparse matrix (W, V) in CSR form by the points of each instance.

    ``points`` (B, V, 3) -> ``products`` (B, W, 3).
    """
    state = _aligned(points.shape[1] * _ROW)
    row = _aligned(_ROW)
    for first in range(0, points.shape[0], WIDTH):
        count = min(WIDTH, points.shape[0] - first)
        for v in range(points.shape[1]):
            for axis in range(3):
                for lane in range(WIDTH):
                    state[v * _ROW + axis * WIDTH + lane] = points[first + min(lane, count - 1), v, axis]
        for w in range(products.shape[1]):
            x, y, z = _lanes(0.0), _lanes(0.0), _lanes(0.0)
            for k in range(starts[w], starts[w + 1]):
                point, weight = _point(state, columns[k]), weights[k]
                x, y, z = x + weight * point[0], y + weight * point[1], z + weight * point[2]
            _put(row, 0, x, y, z)
            for lane in range(count):
                for axis in range(3):
                    products[first + lane, w, axis] = row[axis * WIDTH + lane]
