// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/run.hpp"
#include "rpc/core/point.hpp"
#include "rpc/io/atomic_file.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <string>
#include <vector>

namespace rpc
{

struct Scene;

/// Places of the undeformed body at which results are asked for: an entry of "Output->Points".
struct ResultPoints {
  std::string name;
  std::vector<Point> place; ///< [m]
};

/// Declares the list of entries in that of the output.
void add_points_parameters(Teuchos::ParameterList &output);
/// @param dim  of the body
/// @throws rpc::Error (bad_input) on an entry that has no places or something that is none, naming it
std::vector<ResultPoints> points_options(const Teuchos::ParameterList &list, int dim);

/// Results at the points: (points of all entries, columns of `names`) on rank 0, no rows elsewhere.
struct PointValues {
  std::vector<std::string> names; ///< headings
  std::vector<std::vector<double>> rows;
  std::vector<double> off; ///< (points) how far the point of the mesh whose results these are lies from the point [m]
};
/// Displacements and recovered stresses at nodes, interpolated by the cell's shape functions; the contact pressure where the point lies on a contact
/// side, else NaN. Collective.
PointValues values_at(const std::vector<ResultPoints> &points, const Scene &scene, const analysis::Solution &solution);

/// Refuses points that lie outside of the body. Collective.
/// @throws rpc::Error (bad_input) on every rank, naming the point and how far away the body is
void require_inside(const std::vector<ResultPoints> &points, const fem::Discretization &d, const UnitNames &units);

/// The table of results at points: for each step, or the only one, a row for each point. It grows with each step; after a restart it goes on with
/// the rows of the steps before.
class PointsFile
{
public:
  /// Adds the solution if it is not in yet. Collective.
  /// @param path  empty: none is wanted
  void update(const std::string &path, const Scene &scene, const analysis::Solution &solution);

private:
  std::unique_ptr<io::GrowingFile> file_; // rank 0 only
  bool begun_ = false;
  double last_ = 0; // time
};

} // namespace rpc
