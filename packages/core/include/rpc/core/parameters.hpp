// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"

#include <Teuchos_ParameterList.hpp>
#include <iosfwd>
#include <string>
#include <vector>

/// Deck handling that every package shares: validation with helpful refusals, fields, documentation.
///
/// Each package owns its XOptions, a valid_parameters() with defaults, units, ranges and docs, and an x_options(list)
/// that reads a validated list; beyond it no code reads a ParameterList.
namespace rpc
{

/// A copy of an entry, its value alone, that nobody has asked for yet.
/// @param is_default  whether the copy says that the user did not give it
Teuchos::ParameterEntry unread(const Teuchos::ParameterEntry &entry, bool is_default);

/// Declares `name` in a valid_parameters() list as a field: a number, or an expression of x, y, z, t in a string.
void set_field(Teuchos::ParameterList &valid, const std::string &name, const std::string &default_value,
               const std::string &doc);

/// Text of a field parameter, which a deck may give as int, double or string.
std::string field_text(const Teuchos::ParameterList &list, const std::string &name);

/// Declares an array of fields, by default empty: a deck gives numbers, or texts with expressions.
void set_fields(Teuchos::ParameterList &valid, const std::string &name, const std::string &doc);

/// Texts of an array of fields, which a deck may give as ints, doubles or strings.
std::vector<std::string> field_texts(const Teuchos::ParameterList &list, const std::string &name);

/// Declares `name` as a choice among some words. A deck may also give a bool, as it did before there were more than two.
/// @param words  the first is the default and what `true` stands for, the last what `false` stands for
void set_choice(Teuchos::ParameterList &valid, const std::string &name, const std::vector<std::string> &words,
                const std::string &doc);

/// Declares `name` as one of some words, of which the first is the default.
void set_words(Teuchos::ParameterList &valid, const std::string &name, const std::vector<std::string> &words,
               const std::string &doc);

/// Declares a sublist whose content is handed on to a library unread.
void set_pass_through(Teuchos::ParameterList &valid, const std::string &name, const std::string &doc);

/// Declares a sublist whose entries are named by the user, all of them sublists of the form `entry`.
/// The deck may hold any number of them; valid defaults are filled in for each.
void set_named_entries(Teuchos::ParameterList &valid, const std::string &name, const Teuchos::ParameterList &entry,
                       const std::string &doc);

/// Checks names and types of `list` against `valid`, recursively, and fills in the defaults, whose entries
/// then say isDefault().
///
/// An int is taken where a double is asked for. Path in messages: "Contact->Yield Stress".
/// @throws rpc::Error (bad_input) naming the parameter, what is allowed and, for a misspelt name, the nearest valid one
void validate(Teuchos::ParameterList &list, const Teuchos::ParameterList &valid, const std::string &path = "");

/// Applies one assignment "Contact->Yield Stress=16" to a list that is not validated yet. The text is read as the type
/// that `valid` gives the parameter; below a pass-through sublist as the first of int, double, bool, string that fits.
/// @throws rpc::Error (bad_input) on an unknown path or a text that does not read as that type
void assign(Teuchos::ParameterList &list, const Teuchos::ParameterList &valid, const std::string &assignment);

/// "deck: unknown parameter "Linear Solver->Belos->Verbose". Did you mean "Verbosity"?", to be thrown (bad_input).
/// @param path        of the list that has it
/// @param candidates  names that are valid there
Error unknown_parameter(const std::string &path, const std::string &name, const std::vector<std::string> &candidates);

/// Refuses parameters that a library would ignore silently.
/// @param known  names that are valid in the list
/// @throws rpc::Error on the first other name, as unknown_parameter() says it
void require_known(const Teuchos::ParameterList &given, const std::vector<std::string> &known, const std::string &path);

/// Names of a list's parameters and sublists, in its order.
std::vector<std::string> names_of(const Teuchos::ParameterList &list);

/// The name among `candidates` nearest to `name`: by edit distance, up to a third of the letters, as an abbreviation with the same first
/// letter, as what `name` begins with, or by the same words in another order; empty if none bears any likeness.
std::string nearest_name(const std::string &name, const std::vector<std::string> &candidates);

/// "a, b, c"
std::string join(const std::vector<std::string> &names);

/// Prints every parameter of `valid` with type, default and doc, as nested Markdown lists.
void print_parameters(std::ostream &out, const Teuchos::ParameterList &valid, const std::string &path = "");

} // namespace rpc
