// vtk_messages.h: captures VTK's warnings and errors, so that they can be thrown as one line.
#pragma once

#include <string>

class vtkObject;

namespace espdiff {

/// While it lives, VTK's messages are stored instead of printed. Only one at a time, on one thread.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  bool has_error() const { return !first_error_.empty(); }
  /// The first error in one line, without VTK's source position; empty if there was none.
  const std::string& first_error() const { return first_error_; }

 private:
  static void receive(vtkObject* sender, unsigned long event, void* self, void* text);

  std::string first_error_;
  unsigned long observer_ = 0;
  int mode_before_ = 0;
  int verbosity_before_ = 0;
};

}  // namespace espdiff
