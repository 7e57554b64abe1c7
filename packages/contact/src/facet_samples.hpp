// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/contact_options.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/fem/discretization.hpp"

#include <array>
#include <functional>
#include <vector>

/// Facets of a contact side on the host, and what the foundation does to them at any of their points. User's expressions and obstacles are
/// evaluated there.
namespace rpc::contact
{

/// The shape functions of a facet at one of its points.
struct FacetShape {
  static constexpr int most_nodes = 9, most_dim = 2;
  double value[most_nodes], slope[most_dim][most_nodes];
  double share = 0; // of the facet that belongs to it, of points of a lattice
};
using EvaluateShape = std::function<void(const double *X, FacetShape &)>;
EvaluateShape shape_of(const mesh::Element &facet);

/// A lattice of points of a facet's reference cell, the vertices among them, with the shares of the trapezoidal rule.
struct Lattice {
  using Nodes = std::array<int, FacetShape::most_nodes>;

  std::vector<FacetShape> points;
  // Where parts_with_halves() are the parts: of the facet's halves, in space four, which are facets of the same element.
  Nodes node{};               // which points are the nodes of the facet
  std::vector<Nodes> of_half; // (halves) the nodes of each
  std::vector<int> half;      // (points) where each lies
  std::vector<int> alike;     // (points) the point that lies in the facet as this one in its half
};

/// @param parts  into which the lattice divides an edge
Lattice lattice_of(const mesh::Element &facet, int parts);
/// The fewest, but no fewer than some, with which a lattice has the nodes of halves and points between them.
int parts_with_halves(const mesh::Element &facet, int parts);

/// Facets of a side, each with what its nodes have: the place [m], the displacement [m], and the columns.
struct FacetRows {
  /// How deep the contact points have been pressed in [m]; whether they bear a pressure (1), are open (0), or have no weight (-1); their
  /// penetration below the dented surface [m], the dents [m] and the pressure [Pa]. A node from which the normal misses the
  /// obstacle is open.
  enum Column { allowed, bearing, penetration, dent, pressure, num_columns };

  HostView<double **> row;       // (facets; nodes * width())
  HostView<LO *> cell;           // (facets)
  HostView<double *> size, area; // (facets) [m], [m^(dim-1), axisymmetric: m^2]
  int nodes = 0, dim = 0;        // of a facet, of the body

  LO num_facets() const { return static_cast<LO>(cell.extent(0)); }
  int width() const { return 2 * dim + num_columns; }
  const double *place(const LO f, const int a) const { return &row(f, a * width()); }
  const double *displacement(const LO f, const int a) const { return place(f, a) + dim; }
  Point point(const LO f, const int a) const { return {place(f, a)[0], place(f, a)[1], dim == 3 ? place(f, a)[2] : 0}; }
  double column(const LO f, const int a, const Column which) const { return place(f, a)[2 * dim + which]; }
  double interpolated(LO f, const FacetShape &shape, Column which) const;

  /// Whether no contact point of a facet bears a pressure.
  bool bears_nothing(LO f) const;
  /// Whether some bear one and others do not.
  bool is_partly_open(LO f) const;
  /// How deep the contact points of a facet have been pressed in, at most [m]: points without weight, which nothing holds, count as that.
  double most_allowed(LO f) const;
};

/// Collective. @param side  which of the contact sides   @param u  (owned dofs) [m]
FacetRows facet_rows(const fem::Discretization &d, const mesh::Side &facets, const ContactNodes &points,
                     const ContactResult &result, int side, const Vector &u);

/// A point of a facet.
struct FacetSample {
  Point place{};          // of the undeformed body [m]
  Point normal{};         // along which penetration is measured
  double along = 0;       // u_nu [m]
  double allowed = 0;     // [m]
  double dent = 0;        // [m]
  bool has_normal = true; // else it is at the centre of an obstacle
};

/// Of the undeformed body, and its displacement there [m].
Point place_at(const FacetRows &rows, LO f, const FacetShape &shape);
Point displacement_at(const FacetRows &rows, LO f, const FacetShape &shape);

/// What the nodes of a facet have, side by side for its samples: place and displacement [m], and of FacetRows what it allows, and the dent [m].
struct FacetNodes {
  static constexpr int displacement = 3, allowed = 6, dent = 7, width = 8;
  int count = 0, dim = 0; // of the facet's nodes; of the body
  double value[width][FacetShape::most_nodes] = {};

  /// Of all nodes, with the values or slopes of their shape functions.
  double sum(const int of, const double *const weight) const
  {
    double sum = 0;
    for (int a = 0; a < count; ++a) sum += weight[a] * value[of][a];
    return sum;
  }
};
FacetNodes facet_nodes(const FacetRows &rows, LO f);
FacetSample sample_at(const FacetNodes &nodes, const FacetShape &shape, const ContactOptions &options);

/// e of (3.15) at a sample [m]; minus infinity where the normal misses the obstacle.
double excess_at(const FacetSample &sample, const ContactOptions &options);
/// u_nu - g at a sample, without dents [m]; minus infinity where the normal misses the obstacle.
double penetration_at(const FacetSample &sample, const ContactOptions &options);

} // namespace rpc::contact
