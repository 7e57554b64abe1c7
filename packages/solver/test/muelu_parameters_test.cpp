// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/muelu_parameters.hpp"

#include "expect_error.hpp"

#include <string>

namespace muelu_parameters_test
{
namespace
{

using rpc::ExitCode;
using rpc::solver::check_muelu_parameters;
using rpc::test::expect_error;
using Teuchos::ParameterList;

void check(const ParameterList &list)
{
  check_muelu_parameters(list, "MueLu");
}

/// A list whose `sublist` holds one parameter.
template <class Value>
ParameterList with(const std::string &sublist, const std::string &name, const Value &value)
{
  ParameterList list;
  list.sublist(sublist).set(name, value);
  return list;
}

TEST(MueLuParameters, WhatTheSmoothersKnowIsTaken)
{
  check({});
  ParameterList list;
  ParameterList &chebyshev = list.sublist("smoother: params");
  chebyshev.set("chebyshev: degree", 3);
  chebyshev.set("chebyshev: ratio eigenvalue", 20.);
  chebyshev.set("chebyshev: max eigenvalue", 2.);
  chebyshev.set("chebyshev: min eigenvalue", 0.1);
  chebyshev.set("chebyshev: boost factor", 1.1);
  chebyshev.set("chebyshev: zero starting solution", true);
  chebyshev.set("chebyshev: eigenvalue relative tolerance", 0.01);
  chebyshev.set("chebyshev: use rowsumabs diagonal scaling", true);
  chebyshev.set("eigen-analysis: type", std::string("cg"));
  chebyshev.set("relaxation: sweeps", 2);
  check(list);

  list = with("smoother: params", "relaxation: type", std::string("Jacobi"));
  list.set("smoother: type", "RELAXATION");
  list.sublist("smoother: params").set("relaxation: damping factor", 0.7);
  list.sublist("smoother: params").set("relaxation: sweeps", 2);
  check(list);

  list = with("smoother: params", "fact: ilut level-of-fill", 1.5);
  list.set("smoother: type", "ILUT");
  check(list);
  list = with("smoother: params", "fact: iluk level-of-fill", 1);
  list.set("smoother: type", "RILUK");
  check(list);
}

TEST(MueLuParameters, OfOtherSmoothersAreLeftToThem)
{
  ParameterList list = with("smoother: params", "schwarz: overlap level", 1);
  list.set("smoother: type", "SCHWARZ");
  check(list);
}

TEST(MueLuParameters, MisspeltNamesInASmoothersListAreRefused)
{
  expect_error(ExitCode::bad_input,
               {"\"MueLu->smoother: params->chebyshev: degre\"", "Did you mean \"chebyshev: degree\"?"},
               [] { check(with("smoother: params", "chebyshev: degre", 3)); });
  expect_error(ExitCode::bad_input, {"->chebyshev: max eigenvale\"", "Did you mean \"chebyshev: max eigenvalue\"?"},
               [] { check(with("smoother: params", "chebyshev: max eigenvale", 3.)); });
  expect_error(ExitCode::bad_input,
               {"\"MueLu->smoother: params->relaxation: sweps\"", "Did you mean \"relaxation: sweeps\"?"}, [] {
                 ParameterList list = with("smoother: params", "relaxation: sweps", 3);
                 list.set("smoother: type", "RELAXATION");
                 check(list);
               });
  expect_error(ExitCode::bad_input, {"->fact: iluk level-of-fil\"", "Did you mean \"fact: iluk level-of-fill\"?"}, [] {
    ParameterList list = with("smoother: params", "fact: iluk level-of-fil", 1);
    list.set("smoother: type", "RILUK");
    check(list);
  });
}

TEST(MueLuParameters, OfAnotherSmootherAreRefused)
{
  expect_error(ExitCode::bad_input, "\"MueLu->smoother: params->relaxation: type\"",
               [] { check(with("smoother: params", "relaxation: type", std::string("Jacobi"))); });
}

TEST(MueLuParameters, EachListIsReadForItsOwnSmoother)
{
  ParameterList list;
  list.set("smoother: pre type", "RELAXATION");
  list.set("smoother: post type", "CHEBYSHEV");
  list.sublist("smoother: pre params").set("relaxation: sweeps", 2);
  list.sublist("smoother: post params").set("chebyshev: degree", 2);
  check(list);
  list.sublist("smoother: post params").set("chebyshev: degrees", 2);
  expect_error(ExitCode::bad_input, "\"MueLu->smoother: post params->chebyshev: degrees\"", [&] { check(list); });
}

TEST(MueLuParameters, OfTheCoarseSolverAreCheckedToo)
{
  check(with("coarse: params", "fix nullspace", true));
  expect_error(ExitCode::bad_input, {"\"MueLu->coarse: params->fix nulspace\"", "Did you mean \"fix nullspace\"?"},
               [] { check(with("coarse: params", "fix nulspace", true)); });
  ParameterList list = with("coarse: params", "chebyshev: degre", 3);
  list.set("coarse: type", "CHEBYSHEV");
  expect_error(ExitCode::bad_input, "Did you mean \"chebyshev: degree\"?", [&] { check(list); });
}

TEST(MueLuParameters, OfASingleLevelAreCheckedWithTheTypesAroundIt)
{
  ParameterList list;
  list.set("smoother: type", "RELAXATION");
  list.sublist("level 1").sublist("smoother: params").set("relaxation: sweeps", 2);
  check(list);
  list.sublist("level 1").sublist("smoother: params").set("chebyshev: degree", 2);
  expect_error(ExitCode::bad_input, "\"MueLu->level 1->smoother: params->chebyshev: degree\"", [&] { check(list); });
  list.sublist("level 1").set("smoother: type", "CHEBYSHEV");
  list.sublist("level 1").sublist("smoother: params").remove("relaxation: sweeps");
  check(list);
  expect_error(ExitCode::bad_input, {"\"MueLu->level 2->smoother: tipe\"", "Did you mean \"smoother: type\"?"},
               [] { check(with("level 2", "smoother: tipe", std::string("RELAXATION"))); });
}

TEST(MueLuParameters, ValuesOfTheWrongTypeAreRefused)
{
  expect_error(ExitCode::bad_input, {"\"MueLu->smoother: params\"", "chebyshev: degree", "int"},
               [] { check(with("smoother: params", "chebyshev: degree", std::string("two"))); });
}

TEST(MueLuParameters, InItsOtherLanguagesAreLeftToMueLu)
{
  check(with("Hierarchy", "anything", 1));
}

} // namespace
} // namespace muelu_parameters_test
