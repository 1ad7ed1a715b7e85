// errors.cpp: one family of exceptions; every one is an espdiff.Error, and what Python calls such a fault as well.
#include "errors.h"

#include <array>
#include <string>

#include "base/error.h"
#include "base/text/translate.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

struct PythonError {
  ErrorClass error_class;
  const char* name;
  PyObject** also;  ///< Python's own class for such a fault
  const char* help;
};

const std::array<PythonError, 9> kErrors = {{
    {ErrorClass::kInput, "InputError", &PyExc_ValueError, "An argument or a molecule that cannot be right."},
    {ErrorClass::kFormat, "FormatError", &PyExc_ValueError, "A file's content is wrong; the message names the line."},
    {ErrorClass::kIo, "IoError", &PyExc_OSError, "A file cannot be opened, read or written."},
    {ErrorClass::kGeometry, "GeometryError", &PyExc_ArithmeticError, "The shapes cannot be processed."},
    {ErrorClass::kConvergence, "ConvergenceError", &PyExc_ArithmeticError, "An iteration did not converge."},
    {ErrorClass::kDevice, "DeviceError", &PyExc_RuntimeError, "The back end is missing or failed."},
    {ErrorClass::kMemory, "OutOfMemoryError", &PyExc_MemoryError, "A grid or mesh does not fit into memory."},
    {ErrorClass::kCancelled, "Cancelled", &PyExc_RuntimeError, "The computation was cancelled."},
    {ErrorClass::kInternal, "InternalError", &PyExc_RuntimeError, "A mistake of espdiff's own; please report it."},
}};

// Immortal, as Python's own exceptions are: errors may be translated until the interpreter ends.
std::array<PyObject*, kErrors.size()> made_classes{};

/// As it is typed: numbers as they are, other values as texts.
std::string literal(const std::string& value) {
  const bool is_number = value.find_first_not_of("0123456789.-+") == std::string::npos;
  return is_number ? value : value.find('"') == std::string::npos ? "\"" + value + "\"" : "'" + value + "'";
}

/// The option grid-spacing of the command line is grid_spacing=1 in Python.
std::string spelled(const NamedOption& option) {
  std::string name = option.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  if (option.is_switch) return "`" + name + "=True`";
  return option.value.empty() ? "`" + name + "`" : "`" + name + "=" + literal(option.value) + "`";
}

void raise(const Error& error) {
  const std::string text = error.message().spelled(spelled);
  for (std::size_t i = 0; i < kErrors.size(); ++i) {
    if (kErrors[i].error_class == error.error_class()) PyErr_SetString(made_classes[i], text.c_str());
  }
}

}  // namespace

void add_errors(nb::module_& module) {
  PyObject* const base =
      PyErr_NewExceptionWithDoc("espdiff.Error", "Base of all that espdiff raises.", nullptr, nullptr);
  module.attr("Error") = nb::borrow(base);
  for (std::size_t i = 0; i < kErrors.size(); ++i) {
    const nb::tuple bases = nb::make_tuple(nb::borrow(base), nb::borrow(*kErrors[i].also));
    const std::string name = std::string("espdiff.") + kErrors[i].name;
    made_classes[i] = PyErr_NewExceptionWithDoc(name.c_str(), kErrors[i].help, bases.ptr(), nullptr);
    module.attr(kErrors[i].name) = nb::borrow(made_classes[i]);
  }
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    } catch (const nb::python_error&) {
      throw;
    } catch (const nb::builtin_exception&) {
      throw;
    } catch (const std::exception& error) {
      raise(translated(error));
    }
  });
}

}  // namespace espdiff::python
