// xml_text.h: reads the part of XML that VTK's files are made of.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace espdiff {

/// An element: its attributes, the elements in it, and the text before the first of them.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< in file order, entities replaced
  std::vector<XmlElement> children;
  std::string_view text;  ///< as it stands in the file, which must outlive the element
  long line = 0;          ///< of the start tag, from 1

  /// The value of an attribute; nullptr when there is none of that name.
  const std::string* attribute(std::string_view wanted) const;
  /// The first child of that name; nullptr when there is none.
  const XmlElement* child(std::string_view wanted) const;
};

/// Reads one root element with its children. Declarations and comments are skipped; document types, CDATA sections and
/// entities other than XML's own five and character codes are refused, since no writer of VTK's files uses them.
/// The element `raw_element` may hold bytes that are no XML when its attribute encoding is "raw": its text then starts
/// behind the first '_' and ends at the file's last end tags. At most 64 levels and 100,000 elements are read.
/// `path` is for messages.
/// @throws FormatError at the line of what is wrong
XmlElement parse_xml(std::string_view text, const std::string& path, std::string_view raw_element);

}  // namespace espdiff
