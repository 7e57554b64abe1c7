// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/load_history.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A block on a foundation under loads that change with time.
namespace rpc::test
{

constexpr double inf = std::numeric_limits<double>::infinity();

inline ScalarField in_time(std::function<double(const Point &, double)> f)
{
  return ScalarField("test", std::move(f));
}

/// A foundation's law; the first four are the families, the last one never yields.
struct Law {
  const char *name;
  double yield, hardening, stiffness;
  double compliance() const { return 1 / stiffness; }
};
inline const Law laws[] = {{"perfectly plastic", 3, 0, inf},
                           {"hardening", 3, 40, inf},
                           {"elastic, perfectly plastic", 3, 0, 200},
                           {"elastic, hardening", 3, 40, 200},
                           {"Winkler", inf, 0, 200}};

inline contact::ContactOptions foundation(const std::string &side, const Law &law)
{
  contact::ContactOptions options;
  options.side = side;
  options.path = "Contact->Sides->" + side;
  options.yield_stress = ScalarField(law.yield);
  options.hardening = ScalarField(law.hardening);
  options.stiffness = ScalarField(law.stiffness);
  return options;
}

inline std::shared_ptr<const mesh::Mesh> block(const int refinement = 1)
{
  const mesh::BoxOptions box{{0, 0}, {2, 1}, {12 * refinement, 6 * refinement}, {2, 1}};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}

/// Close solves, for numbers to be compared to 1e-9.
inline analysis::StepOptions close()
{
  analysis::StepOptions options;
  options.uzawa.tolerance = 1e-11;
  options.newton.residual_tolerance = 1e-12;
  return options;
}
inline analysis::LoadHistory history_of(const analysis::Model &model, const analysis::StepOptions &options = close(),
                                        const int halvings = 0, const double first_time = 1, const int refinement = 1)
{
  return {std::make_shared<analysis::Problem>(block(refinement), model, first_time), options, halvings};
}

inline analysis::StepSolution advance(analysis::LoadHistory &history, const double t)
{
  analysis::StepSolution s = history.advance(t);
  EXPECT_TRUE(s.uzawa.converged) << "t = " << t << ": " << s.uzawa.reason;
  return s;
}

inline fem::DirichletCondition prescribed(const std::string &side, const std::optional<ScalarField> &x,
                                          const std::optional<ScalarField> &y)
{
  return {side, side, {x, y, std::nullopt}};
}

/// |a - b|_2 / |b|_2
inline double distance(const MultiVector &a, const MultiVector &b)
{
  double square = 0, size = 0;
  for (std::size_t k = 0; k < a.getNumVectors(); ++k) {
    Vector difference(*a.getVector(k), Teuchos::Copy);
    difference.update(-1., *b.getVector(k), 1.);
    square += std::pow(difference.norm2(), 2);
    size += std::pow(b.getVector(k)->norm2(), 2);
  }
  return std::sqrt(square / size);
}

// A block that is pressed uniformly ---------------------------------------------------------------------------------------

constexpr double young = 100, poisson = 0.3;
/// Stress over strain where the sides slide [Pa].
constexpr double modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));

/// Sides that slide; the top goes down by `pressed`, and a flat foundation is below.
inline analysis::Model column(const Law &law, std::function<double(double)> pressed)
{
  analysis::Model model;
  model.materials = fem::Material{young, poisson};
  model.dirichlet = {
      prescribed("left", ScalarField(0.), std::nullopt), prescribed("right", ScalarField(0.), std::nullopt),
      prescribed("top", std::nullopt, in_time([pressed](const Point &, const double t) { return -pressed(t); }))};
  model.contact = {foundation("bottom", law)};
  return model;
}

// A block that is pressed unevenly ----------------------------------------------------------------------------------------

/// Pressed and pushed aside by loads that follow `load`, held at the left, on a foundation that is uneven.
inline analysis::Model uneven(const Law &law, std::function<double(double)> load)
{
  analysis::Model model;
  model.materials = fem::Material{young, poisson};
  model.tractions.push_back({"top",
                             "top",
                             {in_time([load](const Point &, const double t) { return 0.2 * load(t); }),
                              in_time([load](const Point &x, const double t) { return -load(t) * (1 + x[0]); })}});
  model.dirichlet = {prescribed("left", ScalarField(0.), std::nullopt)};
  model.dirichlet.push_back(prescribed(
      "right", std::nullopt, in_time([load](const Point &x, const double t) { return -0.004 * load(t) * x[1]; })));
  auto below = foundation("bottom", law);
  below.gap = in_time([](const Point &x, double) { return 0.004 * x[0]; });
  model.contact = {below};
  return model;
}
inline double ramp(const double t)
{
  return 2.2 * t;
}
/// Up by t = 1, back by 2, up again by 3, on by 4.
inline double to_and_fro(const double t)
{
  return 2.2 * (t <= 1 ? t : t <= 2 ? 1 - 0.8 * (t - 1) : t <= 3 ? 0.2 + 0.8 * (t - 2) : 1 + 0.3 * (t - 3));
}

} // namespace rpc::test
