// message.h: text for people that names options; the front end that shows it spells them.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace espdiff {

/// An option as a message names it.
struct NamedOption {
  std::string name;        ///< "grid-spacing"
  std::string value;       ///< "1"; empty where the message names the option only
  bool is_switch = false;  ///< it stands for yes: `--overwrite` on the command line, `-overwrite 1` in Tcl
};

/// How a front end writes an option: the command line `--align none`, Tcl `-align none`, the window by its label.
using OptionSpelling = std::function<std::string(const NamedOption&)>;

/// As files and other programs get it: "align none".
std::string bare_name(const NamedOption& option);

/// The one command that most likely helps: the one that was typed, with other options.
struct NextCommand {
  std::string before;                ///< what stands before it: "apt install X && ", or ""
  std::vector<NamedOption> options;  ///< given besides, or instead of their earlier values

  bool empty() const { return before.empty() && options.empty(); }
};

/// A line of text whose options are not spelled yet. It is put together like a string:
///   "use a larger " + option("grid-spacing") + " or fewer atoms"
class Message {
 public:
  Message() = default;
  // Not explicit: most messages name no option.
  Message(const char* text) : Message(std::string(text)) {}
  Message(const std::string& text);
  Message(NamedOption option);

  Message& operator+=(const Message& more);
  friend Message operator+(Message a, const Message& b) { return a += b; }

  bool empty() const { return parts_.empty(); }
  /// What to type next; front ends that have a command line show it behind the text. Stays with the message when it
  /// becomes a part of another one.
  Message& set_next(NextCommand next);
  const NextCommand& next() const { return next_; }
  /// With bare_name().
  std::string plain() const;
  std::string spelled(const OptionSpelling& spelling) const;

 private:
  /// Text, or an option where `option.name` is not empty.
  struct Part {
    std::string text;
    NamedOption option;
  };
  std::vector<Part> parts_;
  NextCommand next_;
};

/// Names an option, with a value that is advised or was given.
inline Message option(const std::string& name, const std::string& value = "") { return NamedOption{name, value}; }
/// Names an option of yes or no that is to be given.
inline Message switched_on(const std::string& name) { return NamedOption{name, "", true}; }

}  // namespace espdiff
