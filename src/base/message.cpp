// message.cpp: messages as text, with options spelled.
#include "base/message.h"

#include <utility>

namespace espdiff {

Message::Message(const std::string& text) {
  if (!text.empty()) parts_.push_back({text, {}});
}

Message::Message(NamedOption option) { parts_.push_back({"", std::move(option)}); }

Message& Message::operator+=(const Message& more) {
  const std::vector<Part> added = more.parts_;  // `more` may be this
  parts_.insert(parts_.end(), added.begin(), added.end());
  if (next_.empty()) next_ = more.next_;
  return *this;
}

Message& Message::set_next(NextCommand next) {
  next_ = std::move(next);
  return *this;
}

std::string Message::plain() const { return spelled(bare_name); }

std::string bare_name(const NamedOption& option) {
  return option.value.empty() ? option.name : option.name + " " + option.value;
}

std::string Message::spelled(const OptionSpelling& spelling) const {
  std::string text;
  for (const Part& part : parts_) text += part.option.name.empty() ? part.text : spelling(part.option);
  return text;
}

}  // namespace espdiff
