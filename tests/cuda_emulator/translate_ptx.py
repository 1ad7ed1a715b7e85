#!/usr/bin/env python3
"""translate_ptx.py: makes C++ of the PTX in an object file, so that kernels can be tested where there is no GPU.

Usage: translate_ptx.py OUTPUT OBJECT

The object must hold its PTX uncompressed (nvcc --no-compress, a virtual architecture). OUTPUT gets a function for each
kernel, which runs one thread, and an entry in the table of kernel.h. Registers become variables, branches become goto,
and an instruction becomes a call of what ptx_instructions.h says that it does. A kernel that several objects have (an
instance of a template) is in the table once. An OUTPUT whose text stays the same is not written.

An instruction that is not known ends the translation with the names of the instruction and of the kernel: what is not
translated is not tested. The reference is NVIDIA's "Parallel Thread Execution ISA".
"""
import os
import re
import sys

from ptx_function import Function
from ptx_text import C_TYPES, Unknown, c_name, parse_variable, size_of, split_operands

LONG_FUNCTION = 4000
"""Lines from which a function is not optimized, since the compiler's time grows faster than their number."""


class Module:
    """The PTX of one object file."""

    def __init__(self, text):
        self.variables = {}  # of global and constant memory: name -> C++ name
        self.shared = {}  # name -> alignment, bytes
        self.functions = {}
        self.declared = set()
        self.definitions = []
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
        self.parse(re.sub(r"//[^\n]*", "", text))

    def parse(self, text):
        i = 0
        while True:
            i = re.compile(r"\s*").match(text, i).end()
            if i >= len(text):
                return
            if re.compile(r"\.(version|target|address_size|file)\b").match(text, i):
                i = (text + "\n").index("\n", i)
                continue
            match = re.compile(r"(?:\.(?:visible|weak|extern|common)\s+)*\.(entry|func)\b").match(text, i)
            if match:
                i = self.parse_function(text, match)
            else:
                end = text.index(";", i)
                self.parse_variable(" ".join(text[i:end].split()))
                i = end + 1

    def parse_function(self, text, start):
        head = re.compile(r"\s*(?:\((.*?)\)\s*)?([\w$]+)\s*(?:\((.*?)\))?([^;{]*)", re.S).match(text, start.end())
        result, name, parameters, directives = head.groups()
        i = head.end()
        if text[i] == ";":
            self.declared.add(name)
            return i + 1
        depth = 0
        for end in range(i, len(text)):
            depth += (text[end] == "{") - (text[end] == "}")
            if depth == 0:
                break
        limit = re.search(r"\.maxntid\s+(\d+)(?:\s*,\s*(\d+))?(?:\s*,\s*(\d+))?", directives)
        max_threads = 1024
        if limit:
            max_threads = int(limit.group(1)) * int(limit.group(2) or 1) * int(limit.group(3) or 1)
        self.functions[name] = Function(self, name, start.group(1) == "entry",
                                        [self.parse_parameter(x) for x in split_operands(parameters or "")],
                                        self.parse_parameter(result) if result else None, text[i + 1:end], max_threads)
        return end + 1

    @staticmethod
    def parse_parameter(text):
        text = re.sub(r"\.ptr\s+(\.(global|shared|local|const)\s+)?(\.align\s+\d+\s+)?", "", " ".join(text.split()))
        _, name, _, n_bytes = parse_variable(text)
        return name, n_bytes

    def parse_variable(self, text):
        declaration, _, value = text.partition("=")
        space, name, alignment, n_bytes = parse_variable(declaration)
        if space == "shared":
            self.shared[name] = (alignment, n_bytes)
            return
        type_name = re.search(r"\.(pred|[busf]\d+)\s", declaration).group(1)
        self.variables[name] = c_name("g_", name)
        values = ", ".join(self.literal(x, type_name) for x in split_operands(value.strip().strip("{}")))
        self.definitions.append(f"alignas({max(alignment, 16)}) {C_TYPES[type_name]} {self.variables[name]}"
                                f"[{n_bytes // size_of(type_name)}] = {{{values}}};")

    @staticmethod
    def literal(text, type_name):
        if re.fullmatch(r"0[fF][0-9a-fA-F]{8}", text):
            return f"bits<float>(0x{text[2:]}U)"
        if re.fullmatch(r"0[dD][0-9a-fA-F]{16}", text):
            return f"bits<double>(0x{text[2:]}ULL)"
        if re.fullmatch(r"-?(0x[0-9a-fA-F]+|\d+)U?", text):
            return f"static_cast<{C_TYPES[type_name]}>({text.rstrip('U')})"
        raise Unknown(f"initial value {text}")

    def meets_others(self, function, seen=()):
        return function.meets_others or any(
            self.meets_others(self.functions[name], seen + (name,))
            for name in function.calls if name in self.functions and name not in seen)

    def translate(self):
        """The C++ text."""
        lines = ["// Made by translate_ptx.py.", '#include "ptx_instructions.h"', "", "namespace cuda_emulator {", "namespace {", ""]
        lines += self.definitions
        bodies = {name: function.translate() for name, function in self.functions.items()}
        table = []
        for name in sorted(self.declared - set(self.functions)):
            lines.append(f"using external::{c_name('function_', name)};")
        for name, function in self.functions.items():
            if not function.is_kernel:
                lines.append(f"void {c_name('function_', name)}(Thread*, void*, void**);")
        for name, function in self.functions.items():
            if bodies[name].count("\n") > LONG_FUNCTION:
                lines.append('[[gnu::optimize("O0")]]')
            lines += [f"void {c_name('function_', name)}([[maybe_unused]] Thread* t, [[maybe_unused]] void* result,",
                      "    [[maybe_unused]] void** parameters) {",
                      "  [[maybe_unused]] uint32_t carry = 0;", bodies[name], "}"]
            if function.is_kernel:
                sizes = ", ".join(str(n_bytes) for _, n_bytes in function.parameters)
                table.append(f'const Registered kernel_{len(table)}({{"{name}", {c_name("function_", name)}, '
                             f"{str(self.meets_others(function)).lower()}, {function.shared_bytes}, {function.max_threads}, "
                             f"{{{sizes}}}}});")
        return "\n".join(lines + table + ["", "}  // namespace", "}  // namespace cuda_emulator", ""])


def ptx_of(path):
    """The PTX text in an object file; the first, where there are several."""
    with open(path, "rb") as file:
        data = file.read()
    start = data.find(b".version ")
    if start < 0:
        raise SystemExit(f"translate_ptx.py: {path}: no PTX text; compile with --no-compress and for a virtual architecture "
                         "(CMAKE_CUDA_ARCHITECTURES=90 or 90-virtual)")
    return data[start:data.index(b"\0", start)].decode()


def write_if_changed(path, text):
    """Leaves a file of the same text alone, with its time: nothing that is made of it is made again."""
    if os.path.exists(path):
        with open(path, encoding="ascii") as file:
            if file.read() == text:
                return
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def main(arguments):
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    output, path = arguments
    try:
        text = Module(ptx_of(path)).translate()
    except Unknown as error:
        raise SystemExit(f"translate_ptx.py: {path}: not known: {error}") from error
    write_if_changed(output, text)


if __name__ == "__main__":
    main(sys.argv[1:])
