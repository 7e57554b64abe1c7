// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <utility>
#include <vector>

namespace rpc::io
{

/// An element of an XML deck and where it begins.
struct XmlElement {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes; ///< entities resolved
  std::vector<XmlElement> children;
  int line = 0, column = 0; ///< of its "<"

  /// The value of an attribute; null if it has none of that name.
  const std::string *attribute(const std::string &name) const;
};

/// Reads the text of an XML deck far enough to say what is wrong with its tags, in words of decks rather than of XML.
/// @param path  of the file, for messages
/// @throws rpc::Error (bad_input) with path, line, what is open and what to write
XmlElement read_xml_elements(const std::string &path, const std::string &text);

/// Checks tags, attributes, names that are given twice, and values against their types.
/// @param valid  what the deck may have; empty: that is not known
/// @throws rpc::Error (bad_input) with path, line, the parameter's name, its value and what to write
void check_xml_deck(const std::string &path, const XmlElement &root, const Teuchos::ParameterList &valid);

} // namespace rpc::io
