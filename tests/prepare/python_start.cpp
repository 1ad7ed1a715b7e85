// A program of Python starts as it does by itself, without the packages that it does not use; another one as it is.
#include "system/python_start.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "io/files/run_program.h"
#include "support/test_data.h"

using espdiff::words_to_start;
using espdiff_test::ScratchFolder;

namespace {

std::string printed_by(const std::vector<std::string>& words) {
  espdiff::ProgramCall call;
  call.words = words;
  call.words.insert(call.words.end(), {"one", "two words"});
  const espdiff::ProgramResult result = espdiff::run_program(call);
  INFO(result.messages);
  CHECK(result.status == 0);
  return result.output;
}

bool lacks_numpy(const std::string& printed) {
  if (printed != "no NumPy\n") return false;
  MESSAGE("SKIPPED: no NumPy; install it (Debian: python3-numpy)");
  return true;
}

}  // namespace

TEST_CASE("words_to_start: packages that a program of Python does not use are not loaded") {
  const ScratchFolder folder;
  for (const char* package : {"requests", "pkg_resources"}) {
    std::filesystem::create_directory(folder.file(package));
    folder.write(std::string(package) + "/__init__.py",
                 "print(__name__, 'loaded')\nvalue = 5\nresource_filename = None\n");
  }
  folder.write("requests/part.py", "value = 7\n");
  folder.write("other.py", "");
  const std::string head =
      "#!/usr/bin/env python3\nimport sys\nprint(__name__, __file__ == sys.argv[0], sys.argv[1:])\n";
  const std::string first = "__main__ True ['one', 'two words']\n";
  const auto printed = [&](const std::string& body) {
    const std::string program = folder.write("a program", head + body);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string by_itself = printed_by({program}), started = printed_by(words_to_start(program));
    CHECK(by_itself.find(first) == 0);
    CHECK(started.find(first) == 0);
    return std::pair(by_itself.substr(first.size()), started.substr(first.size()));
  };
  const auto [all, some] = printed("import requests, pkg_resources, other\nprint(other.__name__)\n");
  CHECK(all == "requests loaded\npkg_resources loaded\nother\n");
  CHECK(some == "other\n");
  const auto [used, used_later] = printed("import requests\nprint('begin')\nprint(requests.value, requests.value)\n");
  CHECK(used == "requests loaded\nbegin\n5 5\n");
  CHECK(used_later == "begin\nrequests loaded\n5 5\n");
  CHECK(printed("from requests import part\nprint(part.value)\n").second == "requests loaded\n7\n");
  const std::string place =
      "import other\nfrom pkg_resources import resource_filename as find\nprint(find and find('other', 'a.cfg'))\n";
  CHECK(printed(place).second == folder.file("a.cfg") + "\n");
}

TEST_CASE("words_to_start: norms and products of vectors have NumPy's bits, and its errors") {
  const ScratchFolder folder;
  folder.write("pdb2pqr.py", "");
  const std::string program = folder.write("a program", R"(#!/usr/bin/python3
import random, sys
import pdb2pqr
try:
    import numpy as np
except ImportError:
    print("no NumPy")
    sys.exit()
print(np.linalg.norm.__module__, np.cross.__module__, file=sys.stderr)
random.seed(5)
for i in range(2000):
    a, b = (np.array([random.gauss(0, 10 ** random.randint(-9, 9)) for _ in range(3)]) for _ in range(2))
    print(np.linalg.norm(a).hex(), [x.hex() for x in np.cross(a, b)], type(np.linalg.norm(a - b)).__name__)
whole, flat = np.arange(3), np.array([1.0, 2.0])
for of in (whole, flat, np.eye(3), [3, 4], np.array([1e200, 1, 1]), np.array([np.nan, 1, 1]), np.array([])):
    print(np.linalg.norm(of), np.linalg.norm(of, 1), np.linalg.norm(of, axis=-1))
print(np.cross(whole, whole[::-1]), np.cross(flat, flat[::-1]), np.cross(np.eye(3), whole))
for call in (lambda: np.cross([1.0], [2.0]), lambda: np.linalg.norm(flat, 7, 9), lambda: np.cross(np.eye(4), flat)):
    try:
        print(call())
    except Exception as error:
        print(type(error).__name__, error)
)");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string by_itself = printed_by({program});
  if (lacks_numpy(by_itself)) return;
  CHECK(by_itself.size() > 100000);
  espdiff::ProgramCall call;
  call.words = words_to_start(program);
  CHECK(espdiff::run_program(call).messages.find("__main__ __main__\n") == 0);  // the short ways are there
  CHECK(by_itself == printed_by(words_to_start(program)));
}

TEST_CASE("words_to_start: parts of NumPy are loaded where they are used") {
  const ScratchFolder folder;
  const std::string program = folder.write("a program", R"(#!/usr/bin/python3
import sys
try:
    import numpy, urllib.request, xml.sax.saxutils
except ImportError:
    print("no NumPy")
    sys.exit()
names = ["numpy.random", "numpy.fft", "numpy.ma", "numpy.polynomial", "urllib.request"]
print([name for name in names if "__file__" in vars(sys.modules[name])], file=sys.stderr)
from numpy import ma
print(numpy.random.RandomState(1).randint(10), numpy.fft.fft([1, 2]), ma.array([1, 2], mask=[0, 1]))
print(numpy.polynomial.Polynomial([1, 2])(3), urllib.request.pathname2url("a b"))
print([name for name in names if "__file__" not in vars(sys.modules[name])])
)");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string by_itself = printed_by({program});
  if (lacks_numpy(by_itself)) return;
  CHECK(by_itself.find("5 [ 3.+0.j -1.+0.j] [1 --]\n7.0 a%20b\n[]\n") == 0);
  CHECK(by_itself == printed_by(words_to_start(program)));
  espdiff::ProgramCall call;
  call.words = words_to_start(program);
  CHECK(espdiff::run_program(call).messages == "[]\n");
}

TEST_CASE("words_to_start: PDB2PQR's definitions are copied as deeply") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.file("pdb2pqr"));
  folder.write("pdb2pqr/__init__.py", "");
  folder.write("pdb2pqr/definitions.py", "import copy\nclass Residue:\n    atoms = None\n");
  const std::string program = folder.write("a program", R"(#!/usr/bin/python3
import copy, sys
from pdb2pqr import definitions
residue = definitions.Residue()
residue.atoms = [[1, 2]] * 2
deep, flat = definitions.copy.deepcopy(residue), definitions.copy.copy(residue)
residue.atoms[0][0] = 7
print(type(deep).__name__, deep.atoms, deep.atoms[0] is deep.atoms[1], flat.atoms, copy.deepcopy(len))
print(definitions.copy is copy, file=sys.stderr)
)");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string by_itself = printed_by({program});
  CHECK(by_itself == "Residue [[1, 2], [1, 2]] True [[7, 2], [7, 2]] <built-in function len>\n");
  CHECK(by_itself == printed_by(words_to_start(program)));
}

TEST_CASE("words_to_start: PDB2PQR's angles and rotations have its bits") {
  const ScratchFolder folder;
  const std::string program = folder.write("a program", R"(#!/usr/bin/python3
import random, sys, types, warnings
try:
    from pdb2pqr import quatfit
    from pdb2pqr.hydrogens.optimize import Optimize
except ImportError:
    print("no PDB2PQR")
    sys.exit()
print(quatfit.jacobi.__module__, Optimize.get_hbond_angle.__module__, file=sys.stderr)
warnings.simplefilter("ignore")
random.seed(5)
some = (lambda: random.gauss(0, 10 ** random.randint(-9, 9)), lambda: float(random.randint(-2, 2)),
        lambda: random.choice((0.0, random.gauss(0, 1))), lambda: round(random.uniform(-9, 9), 3))
for i in range(1500):
    number = some[i % 4]
    print(quatfit.jacobi([[number() for _ in range(4)] for _ in range(4)], 30))
    print(Optimize.get_hbond_angle(*(types.SimpleNamespace(coords=[number() for _ in range(3)]) for _ in range(3))))
)");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string by_itself = printed_by({program});
  if (by_itself == "no PDB2PQR\n") {
    MESSAGE("SKIPPED: no PDB2PQR for /usr/bin/python3; install it (Debian: pdb2pqr)");
    return;
  }
  CHECK(by_itself.size() > 300000);
  espdiff::ProgramCall call;
  call.words = words_to_start(program);
  CHECK(espdiff::run_program(call).messages == "__main__ __main__\n");  // the short ways are there
  CHECK(by_itself == printed_by(words_to_start(program)));
}

TEST_CASE("words_to_start: another PDB2PQR's functions are left as they are") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.file("pdb2pqr/hydrogens"));
  folder.write("pdb2pqr/__init__.py", "");
  folder.write("pdb2pqr/hydrogens/__init__.py", "");
  const std::string program = folder.write("a program", R"(#!/usr/bin/python3
from pdb2pqr import quatfit
from pdb2pqr.hydrogens.optimize import Optimize
print(quatfit.jacobi.__module__, vars(Optimize).get("get_hbond_angle"))
)");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  folder.write("pdb2pqr/quatfit.py", "def jacobi(matrix):\n    pass\n");
  folder.write("pdb2pqr/hydrogens/optimize.py", "class Optimize:\n    get_hbond_angle = 5\n");
  CHECK(printed_by(words_to_start(program)) == "pdb2pqr.quatfit 5\n");
  folder.write("pdb2pqr/quatfit.py", "from functools import reduce as jacobi\n");
  folder.write("pdb2pqr/hydrogens/optimize.py", "class Optimize:\n    pass # without it\n");
  CHECK(printed_by(words_to_start(program)) == printed_by({program}));
}

TEST_CASE("words_to_start: other programs run as they are") {
  const ScratchFolder folder;
  for (const char* content : {"#!/bin/sh\necho it\n",
                              "\x7f"
                              "ELF",
                              "", "#!/opt/pythonic/run\n", "import sys\n"}) {
    const std::string program = folder.write("program", content);
    CHECK(words_to_start(program) == std::vector<std::string>{program});
  }
  CHECK(words_to_start("/no/such/program") == std::vector<std::string>{"/no/such/program"});
  const std::string program = folder.write("program", "#!/opt/bin/python3.11 -I\n");
  const std::vector<std::string> words = words_to_start(program);
  REQUIRE(words.size() == 5);
  CHECK(words[0] == "/opt/bin/python3.11");
  CHECK(words[1] == "-I");
  CHECK(words[2] == "-c");
  CHECK(words[4] == program);
}
