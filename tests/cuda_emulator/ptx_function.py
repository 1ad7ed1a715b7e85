"""ptx_function.py: makes C++ of a PTX function, an instruction at a time."""
import re

from ptx_text import C_TYPES, IDENTIFIER, Unknown, c_name, parse_variable, size_of, split_operands, statements

WIDER = {"u16": "u32", "s16": "s32", "u32": "u64", "s32": "s64"}
FLOATS = ("f32", "f64")
STATE_SPACES = ("global", "shared", "local", "param", "const")
SPECIAL_REGISTERS = {
    "%laneid": "t->lane()", "%warpid": "(t->index / 32)", "WARP_SZ": "32U",
    "%lanemask_lt": "((1U << t->lane()) - 1U)", "%lanemask_le": "((2U << t->lane()) - 1U)",
    "%lanemask_eq": "(1U << t->lane())",
    "%lanemask_gt": "(~((2U << t->lane()) - 1U))", "%lanemask_ge": "(~((1U << t->lane()) - 1U))",
    "%dynamic_smem_size": "t->dynamic_shared_bytes",
}
for _register, _member in (("tid", "thread"), ("ntid", "block_size"), ("ctaid", "block"), ("nctaid", "grid_size")):
    for _axis in "xyz":
        SPECIAL_REGISTERS[f"%{_register}.{_axis}"] = f"t->{_member}.{_axis}"
# Instructions that are a function of their operands, all of the type that the instruction ends with.
FUNCTIONS = {
    "rem": "remainder_of", "min": "minimum", "max": "maximum", "abs": "absolute", "sqrt": "std::sqrt",
    "rcp": "reciprocal", "rsqrt": "reciprocal_root", "ex2": "std::exp2", "lg2": "std::log2", "sin": "std::sin",
    "cos": "std::cos", "popc": "count_ones", "clz": "leading_zeros", "brev": "reverse_bits",
}


class Function:
    """A kernel (.entry) or a function that kernels call (.func)."""

    def __init__(self, module, name, is_kernel, parameters, result, body, max_threads):
        self.module, self.name, self.is_kernel, self.body = module, name, is_kernel, body
        self.parameters, self.max_threads = parameters, max_threads
        self.registers = {}  # name: type
        self.addresses = {}  # variables in memory: the C++ expression of their address
        self.shared_bytes = 0
        self.dynamic_shared = None
        self.meets_others = False  # has barriers or exchanges values with other threads
        self.calls = set()
        self.branch_targets = {}
        self.declarations = []
        self.last_label = None
        for i, (parameter, _) in enumerate(parameters):
            self.addresses[parameter] = f"p{i}"
            self.declarations.append(f"  char* const p{i} = static_cast<char*>(parameters[{i}]); (void)p{i};")
        if result:
            self.addresses[result[0]] = "static_cast<char*>(result)"

    # ---- operands

    def register(self, name):
        if name not in self.registers:
            raise Unknown(f"register {name}")
        return c_name("r_", name.lstrip("%"))

    def read(self, operand, type_name):
        """The C++ expression of an operand's value, read as a type."""
        if type_name == "pred":
            if operand.startswith("!"):
                return "!" + self.register(operand[1:])
            if re.fullmatch(r"-?\d+", operand):
                return "true" if int(operand) else "false"
            return self.register(operand)
        c_type = C_TYPES[type_name]
        if operand in self.registers:
            return f"as<{c_type}>({self.register(operand)})"
        if operand in SPECIAL_REGISTERS:
            return f"as<{c_type}>({SPECIAL_REGISTERS[operand]})"
        if re.fullmatch(r"0[fF][0-9a-fA-F]{8}", operand):
            return f"as<{c_type}>(bits<float>(0x{operand[2:]}U))"
        if re.fullmatch(r"0[dD][0-9a-fA-F]{16}", operand):
            return f"as<{c_type}>(bits<double>(0x{operand[2:]}ULL))"
        if re.fullmatch(r"-?(0[xX][0-9a-fA-F]+|\d+)U?", operand):
            if type_name in FLOATS:
                raise Unknown(f"an integer for a {type_name}: {operand}")
            return f"static_cast<{c_type}>(0x{int(operand.rstrip('U'), 0) & (2 ** 64 - 1):x}ULL)"
        return f"static_cast<{c_type}>({self.variable(operand)})"

    def variable(self, name):
        """The address of a variable in memory, as an integer; of shared memory, its offset there."""
        if name in self.addresses:
            return f"address({self.addresses[name]})"
        if name in self.module.shared:
            self.add_shared(name, *self.module.shared[name])
            return f"address({self.addresses[name]})"
        if name in self.module.variables:
            return f"address({self.module.variables[name]})"
        raise Unknown(f"symbol {name}")

    def add_shared(self, name, alignment, n_bytes):
        if n_bytes is None:
            self.dynamic_shared = name
            self.addresses[name] = "kDynamicShared"
            return
        self.shared_bytes = (self.shared_bytes + alignment - 1) // alignment * alignment
        self.addresses[name] = f"{self.shared_bytes}U"
        self.shared_bytes += n_bytes

    def place(self, operand, space):
        """Where [base + offset] is: a char*."""
        match = re.fullmatch(r"\[\s*([^+\]]+?)\s*(?:\+\s*(-?\w+)\s*)?\]", operand)
        if not match:
            raise Unknown(f"address {operand}")
        base, offset = match.group(1), int(match.group(2) or "0", 0)
        start = self.read(base, "u64") if base in self.registers else self.variable(base)
        return f"in_{'shared' if space == 'shared' else 'memory'}(t, {start}, {offset})"

    def write(self, operand, value):
        return f"(void)({value});" if operand == "_" else f"set({self.register(operand)}, {value});"

    # ---- statements

    def translate(self):
        lines, scopes = [], []
        for statement in statements(self.body):
            if statement == "{":
                scopes.append(dict(self.registers))
                lines.append("{")
            elif statement == "}":
                self.registers = scopes.pop()
                lines.append("}")
            elif re.fullmatch(IDENTIFIER + ":", statement):
                self.last_label = statement[:-1]
                lines.append(f"{c_name('label_', statement[:-1])}:;")
            else:
                try:
                    lines.append(self.statement(statement, bool(scopes)))
                except (Unknown, KeyError, ValueError, IndexError, StopIteration) as error:
                    raise Unknown(f"`{statement}` ({error!r}) in {self.name}") from error
        constants = ""
        if self.dynamic_shared:
            constants = f"  constexpr uint32_t kDynamicShared = {(self.shared_bytes + 127) // 128 * 128};\n"
        return constants + "\n".join(self.declarations + lines)

    def statement(self, text, in_scope):
        if text.startswith("."):
            declaration = self.directive(text)
            if in_scope:
                return declaration
            self.declarations.append(declaration)  # before any label, so that no goto passes it
            return ""
        condition = ""
        match = re.match(rf"@(!?)\s*({IDENTIFIER})\s+(.*)$", text)
        if match:
            condition = f"if ({match.group(1)}{self.register(match.group(2))}) "
            text = match.group(3)
        words = text.split(None, 1)
        operation = words[0].split(".")
        operands = split_operands(words[1]) if len(words) > 1 else []
        if operation[0] in FUNCTIONS:
            return f"  {condition}{{ {self.call(FUNCTIONS[operation[0]], operation[1:], operands)} }}"
        method = getattr(self, "op_" + operation[0], None)
        if method is None:
            raise Unknown("instruction")
        return f"  {condition}{{ {method(operation[1:], operands, words[-1])} }}"

    def directive(self, text):
        words = text.split()
        if words[0] == ".reg":
            type_name, names = words[1].lstrip("."), []
            for name in split_operands(text.split(None, 2)[2]):
                counted = re.fullmatch(r"(.+?)<(\d+)>", name)
                names += [f"{counted.group(1)}{k}" for k in range(int(counted.group(2)))] if counted else [name]
            for name in names:
                self.registers[name] = type_name
            return f"  {C_TYPES[type_name]} {', '.join(self.register(name) for name in names)};"
        if words[0] in (".shared", ".local", ".param"):
            _, name, alignment, n_bytes = parse_variable(text)
            if words[0] == ".shared":
                self.add_shared(name, alignment, n_bytes)
                return ""
            self.addresses[name] = c_name("v_", name)
            return f"  alignas({max(alignment, 16)}) char {c_name('v_', name)}[{n_bytes}];"
        if words[0] == ".branchtargets":
            self.branch_targets[self.last_label] = split_operands(text.split(None, 1)[1])
            return ""
        if words[0] in (".pragma", ".loc"):
            return ""
        raise Unknown("directive")

    # ---- arithmetic; q: what follows the operation's name, o: the operands

    def binary(self, q, o, symbol):
        c_type, a, b = C_TYPES[q[-1]], self.read(o[1], q[-1]), self.read(o[2], q[-1])
        if any(mode in q for mode in ("rz", "rm", "rp")):
            raise Unknown("rounding mode")
        if q[-1] in FLOATS:
            value = f"{a} {symbol} {b}"
            return self.write(o[0], f"saturate({value})" if "sat" in q else value)
        if "sat" in q:
            raise Unknown("saturation")
        return self.write(o[0], f"static_cast<{c_type}>(wide({a}) {symbol} wide({b}))")

    def op_add(self, q, o, _):
        if "cc" in q:
            return f"add_with_carry(carry = 0, {self.register(o[0])}, {self.read(o[1], q[-1])}, {self.read(o[2], q[-1])});"
        return self.binary(q, o, "+")

    def op_addc(self, q, o, _):
        return f"add_with_carry(carry, {self.register(o[0])}, {self.read(o[1], q[-1])}, {self.read(o[2], q[-1])});"

    def op_sub(self, q, o, _):
        if "cc" in q:
            raise Unknown("carry")
        return self.binary(q, o, "-")

    def op_mul(self, q, o, _):
        if "wide" in q:
            wide = C_TYPES[WIDER[q[-1]]]
            return self.write(o[0], f"multiply_wide<{wide}>({self.read(o[1], q[-1])}, {self.read(o[2], q[-1])})")
        if "hi" in q:
            return self.write(o[0], f"multiply_high({self.read(o[1], q[-1])}, {self.read(o[2], q[-1])})")
        return self.binary(q, o, "*")

    def op_mad(self, q, o, _):
        if "cc" in q:
            raise Unknown("carry")
        if q[-1] in FLOATS:
            return self.op_fma(q, o, _)
        a, b = self.read(o[1], q[-1]), self.read(o[2], q[-1])
        if "wide" in q:
            wide = WIDER[q[-1]]
            value = f"wide(multiply_wide<{C_TYPES[wide]}>({a}, {b})) + wide({self.read(o[3], wide)})"
            return self.write(o[0], f"static_cast<{C_TYPES[wide]}>({value})")
        product = f"multiply_high({a}, {b})" if "hi" in q else f"wide({a}) * wide({b})"
        return self.write(o[0], f"static_cast<{C_TYPES[q[-1]]}>({product} + wide({self.read(o[3], q[-1])}))")

    def op_fma(self, q, o, _):
        return self.write(o[0], f"std::fma({', '.join(self.read(x, q[-1]) for x in o[1:4])})")

    def op_div(self, q, o, _):
        if q[-1] in FLOATS:
            return self.binary(q, o, "/")
        return self.call("divide", q, o)

    def call(self, name, q, o, *types):
        """d = name(a, b ...), the operands of the instruction's type or of those given."""
        given = types or (q[-1],) * (len(o) - 1)
        return self.write(o[0], f"{name}({', '.join(self.read(x, t) for x, t in zip(o[1:], given))})")

    def op_neg(self, q, o, _):
        value = self.read(o[1], q[-1])
        return self.write(o[0], f"-{value}" if q[-1] in FLOATS else f"static_cast<{C_TYPES[q[-1]]}>(0 - wide({value}))")

    def op_copysign(self, q, o, _):
        return self.write(o[0], f"std::copysign({self.read(o[2], q[-1])}, {self.read(o[1], q[-1])})")

    # ---- bits

    def bitwise(self, q, o, symbol):
        return self.write(o[0], f"static_cast<{C_TYPES[q[-1]]}>({self.read(o[1], q[-1])} {symbol} {self.read(o[2], q[-1])})")

    def op_and(self, q, o, _):
        return self.bitwise(q, o, "&")

    def op_or(self, q, o, _):
        return self.bitwise(q, o, "|")

    def op_xor(self, q, o, _):
        return self.bitwise(q, o, "^")

    def op_not(self, q, o, _):
        sign = "!" if q[-1] == "pred" else "~"
        return self.write(o[0], f"static_cast<{C_TYPES[q[-1]]}>({sign}{self.read(o[1], q[-1])})")

    def op_shl(self, q, o, _):
        return self.call("shift_left", q, o, q[-1], "u32")

    def op_shr(self, q, o, _):
        return self.call("shift_right", q, o, q[-1], "u32")

    def op_shf(self, q, o, _):
        if q[1] != "wrap":
            raise Unknown("mode of shf")
        return self.call({"l": "funnel_left", "r": "funnel_right"}[q[0]], q, o, "u32", "u32", "u32")

    def op_prmt(self, q, o, _):
        if len(q) > 1:
            raise Unknown("mode of prmt")
        return self.call("permute_bytes", q, o)

    def op_bfe(self, q, o, _):
        return self.call("extract_bits", q, o, q[-1], "u32", "u32")

    def op_bfi(self, q, o, _):
        return self.call("insert_bits", q, o, q[-1], q[-1], "u32", "u32")

    def op_bmsk(self, q, o, _):
        if q[0] != "clamp":
            raise Unknown("mode of bmsk")
        return self.call("bit_mask", q, o, "u32", "u32")

    def op_bfind(self, q, o, _):
        if "shiftamt" in q:
            raise Unknown("mode of bfind")
        return self.call("highest_bit", q, o)

    def op_lop3(self, q, o, _):
        return self.call("any_logic", q, o, "b32", "b32", "b32", "u32")

    # ---- comparison, choice, conversion, moves

    def op_setp(self, q, o, _):
        a, b = self.read(o[1], q[-1]), self.read(o[2], q[-1])
        symbols = {"eq": "==", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">=",
                   "lo": "<", "ls": "<=", "hi": ">", "hs": ">="}
        if q[-1] in FLOATS and q[0] in ("equ", "neu", "ltu", "leu", "gtu", "geu"):
            value = f"(unordered({a}, {b}) || {a} {symbols[q[0][:2]]} {b})"
        elif q[-1] in FLOATS and q[0] in ("num", "nan"):
            value = f"({'!' if q[0] == 'num' else ''}unordered({a}, {b}))"
        elif q[-1] in FLOATS and q[0] == "ne":
            value = f"(!unordered({a}, {b}) && {a} != {b})"
        else:
            value = f"({a} {symbols[q[0]]} {b})"
        if len(o) > 3:
            combine = next(x for x in q if x in ("and", "or", "xor"))
            value = f"({value} {dict([('and', '&'), ('or', '|'), ('xor', '^')])[combine]} {self.read(o[3], 'pred')})"
        if "|" in o[0]:
            raise Unknown("two results")
        return f"{self.register(o[0])} = {value};"

    def op_selp(self, q, o, _):
        return self.write(o[0], f"{self.read(o[3], 'pred')} ? {self.read(o[1], q[-1])} : {self.read(o[2], q[-1])}")

    def op_mov(self, q, o, _):
        if o[0].startswith("{"):
            parts = split_operands(o[0][1:-1])
            width = 8 * size_of(q[-1]) // len(parts)
            whole = f"const auto whole = {self.read(o[1], 'b' + str(8 * size_of(q[-1])))}; "
            return whole + " ".join(self.write(part, f"static_cast<uint{width}_t>(whole >> {i * width})")
                                    for i, part in enumerate(parts) if part != "_")
        if o[1].startswith("{"):
            parts = split_operands(o[1][1:-1])
            width, whole = 8 * size_of(q[-1]) // len(parts), f"uint{8 * size_of(q[-1])}_t"
            return self.write(o[0], " | ".join(f"static_cast<{whole}>(static_cast<{whole}>({self.read(part, f'b{width}')}) << {i * width})"
                                               for i, part in enumerate(parts)))
        return self.write(o[0], self.read(o[1], q[-1]))

    def op_cvt(self, q, o, _):
        rounding = next((x[1] for x in q if x in ("rn", "rni", "rz", "rzi", "rm", "rmi", "rp", "rpi")), "n")
        mode = {"n": "kNearest", "z": "kTowardZero", "m": "kDown", "p": "kUp"}[rounding]
        if "sat" in q and q[-2] not in FLOATS:
            raise Unknown("saturation")
        value = f"convert<{C_TYPES[q[-2]]}, {mode}>({self.read(o[1], q[-1])})"
        return self.write(o[0], f"saturate({value})" if "sat" in q else value)

    def op_cvta(self, q, o, _):
        value = self.read(o[1], "u64")
        if "shared" in q:
            value = f"{'shared_offset' if 'to' in q else 'shared_address'}(t, {value})"
        return self.write(o[0], value)

    # ---- memory

    def access(self, q):
        """The state space, the number of elements, and whether other threads' accesses are meant to be seen."""
        space = next((x for x in STATE_SPACES if x in q or x + "::cta" in ".".join(q)), "")
        n = next((int(x[1:]) for x in q if x in ("v2", "v4", "v8")), 1)
        return space, n, "strong_" if any(x in q for x in ("volatile", "relaxed", "acquire", "release")) else ""

    def op_ld(self, q, o, _):
        space, n, strong = self.access(q)
        c_type, place = C_TYPES[q[-1]], self.place(o[1], space)
        if n == 1:
            return self.write(o[0], f"{strong}load<{c_type}>({place})")
        return f"const auto loaded = {strong}load<Elements<{c_type}, {n}>>({place}); " + " ".join(
            self.write(register, f"loaded.value[{i}]") for i, register in enumerate(split_operands(o[0][1:-1])))

    def op_st(self, q, o, _):
        space, n, strong = self.access(q)
        c_type, place = C_TYPES[q[-1]], self.place(o[0], space)
        if n == 1:
            return f"{strong}store<{c_type}>({place}, {self.read(o[1], q[-1])});"
        values = ", ".join(self.read(x, q[-1]) for x in split_operands(o[1][1:-1]))
        return f"{strong}store<Elements<{c_type}, {n}>>({place}, {{{{{values}}}}});"

    def op_atom(self, q, o, _):
        kind = next(x for x in q if x in ("add", "min", "max", "and", "or", "xor", "exch", "cas"))
        values = ", ".join(self.read(x, q[-1]) for x in o[2:])
        return self.write(o[0], f"atomic_{kind}<{C_TYPES[q[-1]]}>({self.place(o[1], self.access(q)[0])}, {values})")

    def op_red(self, q, o, _):
        return self.op_atom(q, ["_"] + o, _)

    # ---- control

    def op_bra(self, _q, o, _):
        return f"goto {c_name('label_', o[0])};"

    def op_brx(self, _q, o, _):
        cases = " ".join(f"case {i}: goto {c_name('label_', label)};" for i, label in enumerate(self.branch_targets[o[1]]))
        return f"switch ({self.read(o[0], 'u32')}) {{ {cases} }} __builtin_unreachable();"

    def op_ret(self, _q, _o, _):
        return "return;"

    op_exit = op_ret

    def op_trap(self, _q, _o, _):
        return "trap();"

    def op_call(self, _q, _o, text):
        match = re.match(rf"(?:\((.*?)\)\s*,\s*)?({IDENTIFIER})\s*(?:,\s*\((.*?)\))?\s*$", text)
        result, name, arguments = match.groups()
        self.calls.add(name)
        places = ", ".join(self.addresses[x] for x in split_operands(arguments or "")) or "nullptr"
        return (f"void* arguments[] = {{{places}}}; "
                f"{c_name('function_', name)}(t, {self.addresses[result.strip()] if result else 'nullptr'}, arguments);")

    def nothing(self, _q, _o, _):
        return ""

    # One thread runs at a time, so that memory is always in order.
    op_membar = op_fence = op_griddepcontrol = op_prefetch = nothing

    # ---- threads among each other

    def op_bar(self, q, o, _):
        self.meets_others = True
        if q[0] == "warp":
            return f"warp_barrier(t, {self.read(o[0], 'u32')});"
        if "red" in q:
            kind = next(x for x in q if x in ("or", "and", "popc"))
            return self.write(o[0], f"barrier_{kind}(t, {self.read(o[-1], 'pred')})")
        if "arrive" in q or len(o) > 1:
            raise Unknown("barrier of some threads")
        return f"barrier(t, {self.read(o[0], 'u32')});"

    op_barrier = op_bar

    def op_nanosleep(self, _q, _o, _):
        self.meets_others = True
        return "let_others_run(t);"

    def op_shfl(self, q, o, _):
        self.meets_others = True
        mode = {"idx": "kIndex", "up": "kUp", "down": "kDown", "bfly": "kButterfly"}[q[1]]
        results = o[0].split("|")
        values = ", ".join(self.read(x, "u32") for x in o[1:5])
        text = f"const Shuffled shuffled = shuffle(t, Shuffle::{mode}, {values}); " + self.write(results[0], "shuffled.value")
        return text + (f" {self.register(results[1])} = shuffled.in_range;" if len(results) > 1 else "")

    def op_vote(self, q, o, _):
        self.meets_others = True
        kind = next(x for x in q if x in ("ballot", "any", "all"))
        return self.write(o[0], f"vote_{kind}(t, {self.read(o[1], 'pred')}, {self.read(o[2], 'u32')})")

    def op_match(self, q, o, _):
        self.meets_others = True
        if q[0] != "any":
            raise Unknown("mode of match")
        return self.write(o[0], f"match_any(t, {self.read(o[1], q[-1])}, {self.read(o[2], 'u32')})")
