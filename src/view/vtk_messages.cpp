// vtk_messages.cpp: captures VTK's output window and silences its log.
#include "view/vtk_messages.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>

namespace espdiff {
namespace {

/// VTK writes "ERROR: In file, line n\nvtkClass (address): message\n\n"; only the message is useful to a user.
std::string last_part(const std::string& text) {
  std::string message = text;
  const std::size_t address_end = message.find("): ");
  if (address_end != std::string::npos) message = message.substr(address_end + 3);
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  while (!message.empty() && message.back() == ' ') message.pop_back();
  return message;
}

}  // namespace

VtkMessages::VtkMessages() {
  vtkOutputWindow* window = vtkOutputWindow::GetInstance();
  mode_before_ = window->GetDisplayMode();
  window->SetDisplayModeToNever();
  // The log is a second path to the terminal.
  verbosity_before_ = vtkLogger::GetCurrentVerbosityCutoff();
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(&VtkMessages::receive);
  command->SetClientData(this);
  observer_ = window->AddObserver(vtkCommand::ErrorEvent, command);
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow* window = vtkOutputWindow::GetInstance();
  window->RemoveObserver(observer_);
  window->SetDisplayMode(mode_before_);
  vtkLogger::SetStderrVerbosity(static_cast<vtkLogger::Verbosity>(verbosity_before_));
}

void VtkMessages::receive(vtkObject*, unsigned long, void* self, void* text) {
  auto* messages = static_cast<VtkMessages*>(self);
  if (messages->first_error_.empty() && text != nullptr)
    messages->first_error_ = last_part(static_cast<const char*>(text));
}

}  // namespace espdiff
