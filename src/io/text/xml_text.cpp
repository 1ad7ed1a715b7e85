// xml_text.cpp: a reader of XML by recursive descent, with a limit on depth and number of elements.
#include "io/text/xml_text.h"

#include <algorithm>

#include "base/error.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr int kMostXmlLevels = 64;
constexpr std::size_t kMostElements = 100'000;

bool is_xml_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.' || c == ':';
}

/// A code point in UTF-8.
std::string utf8(unsigned long code) {
  const auto byte = [](unsigned long value) { return static_cast<char>(static_cast<unsigned char>(value)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xc0 | code >> 6), byte(0x80 | (code & 0x3f))};
  if (code < 0x10000) return {byte(0xe0 | code >> 12), byte(0x80 | (code >> 6 & 0x3f)), byte(0x80 | (code & 0x3f))};
  return {byte(0xf0 | code >> 18), byte(0x80 | (code >> 12 & 0x3f)), byte(0x80 | (code >> 6 & 0x3f)),
          byte(0x80 | (code & 0x3f))};
}

class XmlParser {
 public:
  XmlParser(std::string_view text, const std::string& path, std::string_view raw_element)
      : text_(text), path_(path), raw_element_(raw_element) {}

  XmlElement parse() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") position_ = 3;  // byte order mark
    skip_between_elements();
    XmlElement root = parse_element(1);
    skip_between_elements();
    if (position_ != text_.size()) fail("something follows the end of <" + root.name + ">");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) {
    throw FormatError(path_, current_line(), "damaged XML: " + problem + "; write or fetch the file again");
  }

  /// Counts lines on from the last counted place, so that a file is scanned once.
  long current_line() {
    const std::size_t end = std::min(position_, text_.size());
    if (end > counted_to_) {
      line_ += static_cast<long>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_to_),
                                            text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      counted_to_ = end;
    }
    return line_;
  }

  bool next_is(std::string_view what) const { return text_.substr(position_, what.size()) == what; }

  void skip_space() {
    while (position_ < text_.size() && is_xml_space(text_[position_])) ++position_;
  }

  void skip_past(std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, position_);
    if (found == std::string_view::npos) fail(std::string(what) + " does not end");
    position_ = found + end.size();
  }

  void skip_between_elements() {
    for (skip_space();; skip_space()) {
      if (next_is("<?")) {
        skip_past("?>", "a declaration");
      } else if (next_is("<!--")) {
        position_ += 4;
        skip_past("-->", "a comment");
      } else {
        return;
      }
    }
  }

  std::string parse_name(const char* what) {
    const std::size_t begin = position_;
    while (position_ < text_.size() && is_name_character(text_[position_])) ++position_;
    if (begin == position_) fail(std::string(what) + " was expected, but " + shown_next() + " follows");
    return std::string(text_.substr(begin, position_ - begin));
  }

  std::string shown_next() const {
    return position_ < text_.size() ? in_quotes(text_.substr(position_, 1)) : std::string("the end of the file");
  }

  std::string entity(std::string_view name) {
    if (name == "amp") return "&";
    if (name == "lt") return "<";
    if (name == "gt") return ">";
    if (name == "quot") return "\"";
    if (name == "apos") return "'";
    unsigned long code = 0;
    const bool is_hexadecimal = name.substr(0, 2) == "#x";
    const std::string_view digits = name.substr(0, 1) == "#" ? name.substr(is_hexadecimal ? 2 : 1) : "";
    for (const char c : digits) {
      const std::string_view all = "0123456789abcdef";
      const std::size_t digit = all.find(lower_case(std::string_view(&c, 1)));
      if (digit >= (is_hexadecimal ? 16U : 10U) || code > 0x10ffff) fail("entity " + in_quotes(name));
      code = code * (is_hexadecimal ? 16U : 10U) + digit;
    }
    if (digits.empty() || code == 0 || code > 0x10ffff) fail("entity " + in_quotes(name));
    return utf8(code);
  }

  std::string parse_value(const std::string& name) {
    const char quote = position_ < text_.size() ? text_[position_] : '\0';
    if (quote != '"' && quote != '\'') fail("the value of " + name + " is not in quotation marks");
    const std::size_t end = text_.find(quote, position_ + 1);
    if (end == std::string_view::npos) fail("the value of " + name + " does not end");
    const std::string_view raw = text_.substr(position_ + 1, end - position_ - 1);
    if (raw.find('<') != std::string_view::npos) fail("the value of " + name + " has a '<' in it");
    std::string value;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      if (raw[i] == '\0') fail("the value of " + name + " has a character of code 0");
      if (raw[i] != '&') {
        value += raw[i];
        continue;
      }
      const std::size_t semicolon = raw.find(';', i);
      if (semicolon == std::string_view::npos) fail("the value of " + name + " has a '&' that begins no entity");
      value += entity(raw.substr(i + 1, semicolon - i - 1));
      i = semicolon;
    }
    position_ = end + 1;
    return value;
  }

  /// Attributes up to '>' or '/>'; true for the latter.
  bool parse_attributes(XmlElement& element) {
    for (;;) {
      const std::size_t before = position_;
      skip_space();
      if (next_is("/>")) {
        position_ += 2;
        return true;
      }
      if (next_is(">")) {
        ++position_;
        return false;
      }
      if (position_ == before) fail("a blank was expected in <" + element.name + ">, but " + shown_next() + " follows");
      std::string name = parse_name("an attribute");
      skip_space();
      if (!next_is("=")) fail("attribute " + name + " of <" + element.name + "> has no value");
      ++position_;
      skip_space();
      if (element.attribute(name) != nullptr) fail("<" + element.name + "> has two attributes " + name);
      std::string value = parse_value(name);
      element.attributes.emplace_back(std::move(name), std::move(value));
    }
  }

  /// Bytes that are no XML: from the first '_' to the last end tag of this name.
  void take_raw_bytes(XmlElement& element) {
    skip_space();
    if (!next_is("_")) fail("<" + element.name + "> does not begin with '_'");
    const std::size_t end = text_.rfind("</" + element.name);
    if (end == std::string_view::npos || end <= position_) fail("<" + element.name + "> does not end");
    element.text = text_.substr(position_ + 1, end - position_ - 1);
    position_ = end;
  }

  void parse_content(XmlElement& element, int level) {
    const std::string* const encoding = element.attribute("encoding");
    if (element.name == raw_element_ && encoding != nullptr && *encoding == "raw") take_raw_bytes(element);
    bool is_first = element.text.empty();
    for (;;) {
      const std::size_t tag = text_.find('<', position_);
      if (tag == std::string_view::npos)
        fail("<" + element.name + "> of line " + std::to_string(element.line) + " does not end");
      if (is_first) element.text = text_.substr(position_, tag - position_);
      is_first = false;
      position_ = tag;
      if (next_is("<?") || next_is("<!--")) {
        skip_between_elements();
      } else if (next_is("</")) {
        return;
      } else {
        element.children.push_back(parse_element(level + 1));
      }
    }
  }

  XmlElement parse_element(int level) {
    if (!next_is("<")) fail("an element was expected, but " + shown_next() + " follows");
    if (level > kMostXmlLevels)
      fail("elements lie in each other more than " + std::to_string(kMostXmlLevels) + " deep");
    if (++n_elements_ > kMostElements) fail("there are more than " + std::to_string(kMostElements) + " elements");
    XmlElement element;
    element.line = current_line();
    ++position_;
    element.name = parse_name("the name of an element");
    if (parse_attributes(element)) return element;
    parse_content(element, level);
    position_ += 2;
    const std::string end = parse_name("the name of an element");
    if (end != element.name) {
      fail("<" + element.name + "> of line " + std::to_string(element.line) + " ends with </" + end + ">");
    }
    skip_space();
    if (!next_is(">")) fail("</" + end + " is not closed");
    ++position_;
    return element;
  }

  std::string_view text_;
  const std::string& path_;
  std::string_view raw_element_;
  std::size_t position_ = 0;
  std::size_t counted_to_ = 0;
  long line_ = 1;
  std::size_t n_elements_ = 0;
};

}  // namespace

const std::string* XmlElement::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes) {
    if (key == wanted) return &value;
  }
  return nullptr;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  for (const XmlElement& element : children) {
    if (element.name == wanted) return &element;
  }
  return nullptr;
}

XmlElement parse_xml(std::string_view text, const std::string& path, std::string_view raw_element) {
  return XmlParser(text, path, raw_element).parse();
}

}  // namespace espdiff
