// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/muelu_parameters.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/tpetra.hpp"

#include <Ifpack2_Chebyshev.hpp>
#include <Ifpack2_ILUT.hpp>
#include <Ifpack2_Parameters.hpp>
#include <Ifpack2_RILUK.hpp>
#include <Ifpack2_Relaxation.hpp>
#include <MueLu_Amesos2Smoother.hpp>
#include <MueLu_MasterList.hpp>
#include <Tpetra_RowMatrix.hpp>
#include <algorithm>
#include <memory>
#include <regex>

namespace rpc::solver
{
namespace
{

using Teuchos::ParameterList;
using RowMatrix = Tpetra::RowMatrix<double, LO, GO, Node>;
using Smoother = Ifpack2::Preconditioner<double, LO, GO, Node>;

/// Null for types whose lists are left to Ifpack2.
std::unique_ptr<Smoother> make_smoother(const std::string &type)
{
  const RCP<const RowMatrix> none;
  if (type == "CHEBYSHEV") return std::make_unique<Ifpack2::Chebyshev<RowMatrix>>(none);
  if (type == "RELAXATION") return std::make_unique<Ifpack2::Relaxation<RowMatrix>>(none);
  if (type == "ILUT") return std::make_unique<Ifpack2::ILUT<RowMatrix>>(none);
  if (type == "RILUK") return std::make_unique<Ifpack2::RILUK<RowMatrix>>(none);
  return nullptr;
}

/// A copy in which no entry has been asked for.
ParameterList unread(ParameterList list)
{
  for (const std::string &name : names_of(list)) {
    const Teuchos::ParameterEntry &entry = list.getEntry(name);
    list.setEntry(name, rpc::unread(entry, entry.isDefault()));
  }
  return list;
}

/// Names that MueLu and the smoother read, as far as they are known: Relaxation declares its parameters, the others ask for
/// their parameters and set those that are missing.
std::vector<std::string> names_read(Smoother &smoother, const ParameterList &given)
{
  std::vector<std::string> names = {"smoother: use blockcrsmatrix storage", "chebyshev: use rowsumabs diagonal scaling",
                                    "chebyshev: rowsumabs diagonal replacement tolerance",
                                    "chebyshev: rowsumabs diagonal replacement value"};
  const auto add = [&names](const ParameterList &list) {
    for (const std::string &name : names_of(list)) names.push_back(name);
  };
  if (const auto *const relaxation = dynamic_cast<Ifpack2::Relaxation<RowMatrix> *>(&smoother)) {
    add(*relaxation->getValidParameters());
    return names;
  }
  ParameterList defaults, asked = unread(given);
  smoother.setParameters(defaults);
  add(defaults);
  smoother.setParameters(asked);
  for (const std::string &name : names_of(given))
    if (asked.getEntry(name).isUsed()) names.push_back(name);
  return names;
}

/// What may have been meant: `read`, and what smoothers of the type know besides.
std::vector<std::string> candidates(std::vector<std::string> read, const std::string &type)
{
  ParameterList all;
  Ifpack2::getValidParameters(all);
  const std::string prefix = type == "CHEBYSHEV" ? "chebyshev: " : type == "RELAXATION" ? "relaxation: " : "fact: ";
  for (const std::string &name : names_of(all))
    if (name.rfind(prefix, 0) == 0) read.push_back(name);
  return read;
}

void check_smoother(const std::string &type, const ParameterList &given, const std::string &path)
{
  const auto smoother = make_smoother(type);
  if (!smoother) return;
  try {
    const auto read = names_read(*smoother, given);
    for (const std::string &name : names_of(given))
      if (std::find(read.begin(), read.end(), name) == read.end())
        throw unknown_parameter(path, name, candidates(read, type));
    // It has its own words on values, and writes its defaults into a const list: hence a copy.
    smoother->setParameters(ParameterList(given));
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    throw Error(ExitCode::bad_input, "deck: \"" + path + "\": " + one_line(failure.what()));
  }
}

/// The list of a coarse solver that is none of Ifpack2's, of which MueLu ignores unknown names.
void check_direct(const ParameterList &given, const std::string &path)
{
  const MueLu::Amesos2Smoother<double, LO, GO, Node> direct("", {});
  require_known(given, names_of(*direct.GetValidParameterList()), path);
}

/// Whether MueLu hands a coarse solver's list to Ifpack2, or to Epetra's solvers.
bool is_of_ifpack2(const std::string &type)
{
  static const std::regex name("RELAXATION|CHEBYSHEV|ILUT|ILU|RILUK|SCHWARZ|Amesos|none|TOPOLOGICAL|FAST_(ILU|IC|ILDL)|"
                               ".*(BLOCK|BANDED|TRIDI|TRIDIAGONAL)[ _]?RELAXATION");
  return std::regex_match(type, name);
}

/// @param inherited  the list around a level's list, whose types hold where the level names none
void check_list(const ParameterList &list, const ParameterList &inherited, const std::string &path)
{
  const auto type_of = [&](const std::string &name, const std::string &otherwise) {
    for (const ParameterList *const from : {&list, &inherited})
      if (from->isParameter(name) && from->isType<std::string>(name)) return from->get<std::string>(name);
    return otherwise;
  };
  const auto check = [&](const std::string &name, const std::string &type) {
    if (list.isSublist(name)) check_smoother(type, list.sublist(name), path + "->" + name);
  };
  const std::string both = type_of("smoother: type", "CHEBYSHEV");
  check("smoother: params", both);
  check("smoother: pre params", type_of("smoother: pre type", both));
  check("smoother: post params", type_of("smoother: post type", both));
  const std::string coarse = type_of("coarse: type", "");
  check("coarse: params", coarse);
  if (list.isSublist("coarse: params") && !is_of_ifpack2(coarse))
    check_direct(list.sublist("coarse: params"), path + "->coarse: params");
}

bool is_level(const std::string &name)
{
  return name.rfind("level ", 0) == 0;
}

} // namespace

void check_muelu_parameters(const ParameterList &user, const std::string &path)
{
  if (user.isSublist("Hierarchy") || user.isParameter("parameterlist: syntax")) return;
  const ParameterList &known = *MueLu::MasterList::List();
  ParameterList list(path);
  list.setParameters(user);
  for (const std::string &name : names_of(user)) {
    if (!is_level(name)) continue;
    list.remove(name);
    if (!user.isSublist(name)) continue; // MueLu refuses it
    const std::string below = path + "->" + name;
    require_known(user.sublist(name), names_of(known), below);
    check_list(user.sublist(name), user, below);
  }
  require_known(list, names_of(known), path);
  try {
    list.validateParameters(known, 0);
  } catch (const std::exception &failure) {
    throw Error(ExitCode::bad_input, "deck: \"" + path + "\": " + one_line(failure.what()));
  }
  RPC_REQUIRE(!list.isParameter("max levels") || list.get<int>("max levels") > 0,
              "deck: \"" << path << "->max levels\" must be > 0, got " << list.get<int>("max levels"));
  check_list(list, ParameterList(), path);
}

} // namespace rpc::solver
