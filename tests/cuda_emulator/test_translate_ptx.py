#!/usr/bin/env python3
"""test_translate_ptx.py: what the translator makes of small modules, and what it says of what it does not know."""
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
HEADER = ".version 9.0\n.target sm_90\n.address_size 64\n"
KERNEL = """.visible .entry twice(.param .u64 twice_param_0)
.maxntid 128, 1, 1
{
.reg .b32 %r<4>;
.reg .b64 %rd<4>;
ld.param.u64 %rd1, [twice_param_0];
cvta.to.global.u64 %rd2, %rd1;
mov.u32 %r1, %tid.x;
mul.wide.u32 %rd3, %r1, 4;
INSTRUCTION
ret;
}
"""


def run_translator(folder, text):
    """(exit status, what was said, path of the C++ text)"""
    path, made = os.path.join(folder, "small.cu.o"), os.path.join(folder, "made", "small.ptx.cpp")
    with open(path, "wb") as file:
        file.write(b"\x7fELF\0\0" + text.encode() + b"\0rest")
    done = subprocess.run([sys.executable, os.path.join(FOLDER, "translate_ptx.py"), made, path], capture_output=True,
                          text=True, check=False)
    return done.returncode, done.stderr, made


def translate(text):
    """(exit status, what was said, the C++ text or None)"""
    with tempfile.TemporaryDirectory() as folder:
        status, said, made = run_translator(folder, text)
        if not os.path.exists(made):
            return status, said, None
        with open(made, encoding="ascii") as file:
            return status, said, file.read()


class Translation(unittest.TestCase):
    def test_a_kernel_becomes_a_function_and_an_entry_of_the_table(self):
        status, said, made = translate(HEADER + KERNEL.replace("INSTRUCTION", "add.s64 %rd2, %rd2, %rd3;"))
        self.assertEqual((status, said), (0, ""))
        self.assertIn("void function_twice(", made)
        self.assertIn('kernel_0({"twice", function_twice, false, 0, 128, {8}})', made)

    def test_only_a_long_kernel_is_not_optimized(self):
        for n, is_long in (10, False), (5000, True):
            _, _, made = translate(HEADER + KERNEL.replace("INSTRUCTION", "add.s64 %rd2, %rd2, %rd3;\n" * n))
            self.assertEqual('[[gnu::optimize("O0")]]\nvoid function_twice(' in made, is_long)

    def test_barriers_and_shared_memory_are_noted(self):
        body = ".shared .align 16 .b8 tile[512];\nbar.sync 0;"
        _, _, made = translate(HEADER + KERNEL.replace("INSTRUCTION", body))
        self.assertIn("function_twice, true, 512, 128", made)

    def test_a_predicate_guards_its_instruction_alone(self):
        body = ".reg .pred %p<2>;\nsetp.lt.u32 %p1, %r1, 5;\n@!%p1 add.u32 %r1, %r1, 1;"
        _, _, made = translate(HEADER + KERNEL.replace("INSTRUCTION", body))
        self.assertIn("if (!r_p1) { set(r_r1,", made)

    def test_an_unknown_instruction_is_named_with_its_kernel(self):
        status, said, made = translate(HEADER + KERNEL.replace("INSTRUCTION", "frobnicate.b32 %r2, %r1;"))
        self.assertEqual(status, 1)
        self.assertIn("not known: `frobnicate.b32 %r2, %r1`", said)
        self.assertIn("in twice", said)
        self.assertIsNone(made)

    def test_a_mode_that_is_not_known_is_refused_instead_of_ignored(self):
        for instruction in ("add.rz.f32 %r1, %r1, %r1;", "add.sat.s32 %r1, %r1, %r1;", "shf.l.clamp.b32 %r1, %r1, %r1, %r2;",
                            "bmsk.wrap.b32 %r1, %r1, %r2;",
                            "bar.arrive 0, 64;"):
            status, said, _ = translate(HEADER + KERNEL.replace("INSTRUCTION", instruction))
            self.assertEqual(status, 1, instruction)
            self.assertIn("not known", said)

    def test_an_object_without_ptx_says_how_to_compile_it(self):
        status, said, _ = translate("nothing")
        self.assertEqual(status, 1)
        self.assertIn("no PTX text; compile with --no-compress", said)

    def test_an_output_whose_text_stays_the_same_keeps_its_time(self):
        kernel = HEADER + KERNEL.replace("INSTRUCTION", "add.s64 %rd2, %rd2, %rd3;")
        with tempfile.TemporaryDirectory() as folder:
            _, _, made = run_translator(folder, kernel)
            os.utime(made, (1, 1))
            run_translator(folder, "// compiled again\n" + kernel)
            self.assertEqual(os.stat(made).st_mtime, 1)
            run_translator(folder, kernel.replace("add.s64", "sub.s64"))
            self.assertGreater(os.stat(made).st_mtime, 1)


if __name__ == "__main__":
    unittest.main()
