"""ptx_text.py: the small parts of PTX: types, names, statements, declarations."""
import re

C_TYPES = {
    "pred": "bool", "b8": "uint8_t", "u8": "uint8_t", "s8": "int8_t",
    "b16": "uint16_t", "u16": "uint16_t", "s16": "int16_t",
    "b32": "uint32_t", "u32": "uint32_t", "s32": "int32_t", "f32": "float",
    "b64": "uint64_t", "u64": "uint64_t", "s64": "int64_t", "f64": "double",
}
IDENTIFIER = r"[\w$%]+"


class Unknown(Exception):
    """What this translator does not know; the text says what."""


def size_of(type_name):
    """Bytes of a PTX type such as u32."""
    return int(re.sub(r"\D", "", type_name)) // 8


def c_name(prefix, name):
    return prefix + re.sub(r"\W", "_", name)


def split_operands(text):
    """At the commas outside of brackets."""
    operands, current, depth = [], "", 0
    for character in text:
        depth += (character in "{[(") - (character in "}])")
        if character == "," and depth == 0:
            operands.append(current.strip())
            current = ""
        else:
            current += character
    if current.strip():
        operands.append(current.strip())
    return operands


def statements(body):
    """A function's statements, labels (with their colon) and braces of scopes, in order."""
    found, current, i = [], "", 0
    while i < len(body):
        character = body[i]
        if character == "{" and current.strip():  # an operand such as {%f1, %f2}
            end = body.index("}", i)
            current += body[i:end + 1]
            i = end
        elif character in "{}":
            if current.strip():
                found.append(current.strip())
            found.append(character)
            current = ""
        elif character == ";":
            if current.strip():
                found.append(" ".join(current.split()))
            current = ""
        elif character == ":" and re.fullmatch(IDENTIFIER, current.strip()) and body[i + 1:i + 2].isspace():
            found.append(current.strip() + ":")
            current = ""
        else:
            current += character
        i += 1
    return found


def parse_variable(text):
    """The state space, name, alignment and bytes (None: given at launch) of a declaration without its initial value."""
    match = re.fullmatch(r"(?:\.(?:visible|weak|extern|common)\s+)*\.(\w+)\s+(?:\.align\s+(\d+)\s+)?\.(\w+)\s+([\w$]+)(\[(\d*)\])?",
                         text.strip())
    if not match:
        raise Unknown(f"declaration {text}")
    space, alignment, type_name, name, array, n = match.groups()
    n_bytes = None if array == "[]" else size_of(type_name) * int(n or 1)
    return space, name, int(alignment or size_of(type_name)), n_bytes
