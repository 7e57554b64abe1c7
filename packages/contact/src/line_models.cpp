// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/line_models.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/sums.hpp"

#include <algorithm>
#include <utility>

namespace rpc::contact
{
namespace
{

/// moves(:, k, :) <- the components of d at the points' nodes, as far as contact sees them: d_i along the direction. [m]
void take_moves(const ContactNodes &c, const Vector &d, const LO k, const DeviceView<double **> &moves)
{
  const auto x = device_read(d);
  Kokkos::parallel_for(
      "rpc::contact::moves", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int j = 0; j < c.dim; ++j) moves(i, c.dim * k + j) = x(c.dof(i, j));
      });
  Kokkos::fence();
}

/// (points, dim) Slips at u; empty without friction.
DeviceView<double **> slips(const ContactNodes &c, const Vector &u)
{
  if (!c.friction.exists()) return {};
  const DeviceView<double **> e("rpc::contact::e", c.size(), c.dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::slips", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { set_row(e, i, slip(c, i, x)); });
  Kokkos::fence();
  return e;
}

/// Where the points are at some displacement.
struct Places {
  DeviceView<double *> v;  // (points)
  DeviceView<double **> e; // (points, dim), empty without friction

  Places(const ContactNodes &c, const Vector &u) : v(penetrations(c, u)), e(slips(c, u)) {}
  Places(const LO points, const int dim, const bool slip) : v("rpc::contact::v", points)
  {
    if (slip) e = DeviceView<double **>("rpc::contact::e", points, dim);
  }
  KOKKOS_INLINE_FUNCTION Motion operator()(const LO i) const
  {
    return e.extent(0) > 0 ? Motion{v(i), row(e, i)} : Motion{v(i)};
  }
  KOKKOS_INLINE_FUNCTION void set(const LO i, const Motion &at) const
  {
    v(i) = at.penetration;
    if (e.extent(0) > 0) set_row(e, i, at.slip);
  }
};

/// m . d_k at point i, for kernels.
KOKKOS_INLINE_FUNCTION double along(const ContactNodes &c, const DeviceView<double **> &moves, const LO i, const LO k)
{
  double sum = 0;
  for (int j = 0; j < c.dim; ++j) sum += c.direction(i, j) * moves(i, c.dim * k + j);
  return sum;
}

/// x . d_k at point i, for kernels. @param x  (dim)
KOKKOS_INLINE_FUNCTION double inner_product(const ContactNodes &c, const double *const x,
                                            const DeviceView<double **> &moves, const LO i, const LO k)
{
  double sum = 0;
  for (int j = 0; j < c.dim; ++j) sum += x[j] * moves(i, c.dim * k + j);
  return sum;
}

/// `at`, moved by t d_k, for kernels.
KOKKOS_INLINE_FUNCTION void move(const ContactNodes &c, const DeviceView<double **> &moves, const LO i, const LO k,
                                 const double t, Motion &at)
{
  at.penetration += t * along(c, moves, i, k);
  if (!c.friction.exists()) return;
  double normal = 0;
  for (int j = 0; j < c.dim; ++j) normal += c.normal(i, j) * moves(i, c.dim * k + j);
  for (int j = 0; j < c.dim; ++j) at.slip.x[j] += t * (moves(i, c.dim * k + j) - normal * c.normal(i, j));
}

class LineModel : public LineFunction
{
public:
  LineModel(RCP<const Comm> comm, const double slope_at_0, const double elastic_curvature, SmoothedPoints points,
            Places from, DeviceView<double **> moves)
      : comm_(std::move(comm)), slope_at_0_(slope_at_0), elastic_curvature_(elastic_curvature),
        points_(std::move(points)), from_(std::move(from)), moves_(std::move(moves))
  {
  }
  Value at(double t) const override;

private:
  RCP<const Comm> comm_;
  double slope_at_0_, elastic_curvature_;
  SmoothedPoints points_;
  Places from_;
  DeviceView<double **> moves_; // (points, dim)
};

/// This rank's (sum of the changes of the points' forces times the direction, of their stiffness along it) at t.
std::pair<double, double> sums_along(const SmoothedPoints &s, const Places &from, const DeviceView<double **> &moves,
                                     const double t)
{
  double slope = 0, curvature = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::line_model", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &bend) {
        const ContactNodes &c = s.points;
        Motion at = from(i);
        const Response here = s.respond(i, at);
        move(c, moves, i, 0, t, at);
        const Response there = s.respond(i, at);
        for (int k = 0; k < c.dim; ++k) {
          change += (there.force[k] - here.force[k]) * moves(i, k);
          bend += moves(i, k) * inner_product(c, there.block[k], moves, i, 0);
        }
      },
      slope, curvature);
  return {slope, curvature};
}

LineFunction::Value LineModel::at(const double t) const
{
  const auto [slope, curvature] = sums_along(points_, from_, moves_, t);
  const double sums[2] = {slope, curvature};
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  return {slope_at_0_ + elastic_curvature_ * t + all[0], elastic_curvature_ + all[1]};
}

/// What the contact points add to the gradient on a subspace, then to the rows of the curvature, one after the other.
struct SubspaceSums : NumberSums { // n + n n, for n directions
  SmoothedPoints points;
  Places from;
  DeviceView<double **> moves; // (points, n dim)
  DeviceView<double *> coefficient;

  SubspaceSums(const SmoothedPoints &s, const Places &at, const DeviceView<double **> &d, const DeviceView<double *> &a)
      : NumberSums(static_cast<size_type>(a.extent(0) * (a.extent(0) + 1))), points(s), from(at), moves(d),
        coefficient(a)
  {
  }
  KOKKOS_INLINE_FUNCTION void operator()(const LO i, double sum[]) const
  {
    const ContactNodes &c = points.points;
    const LO n = static_cast<LO>(coefficient.extent(0));
    Motion at = from(i);
    const Response here = points.respond(i, at);
    for (LO k = 0; k < n; ++k) move(c, moves, i, k, coefficient(k), at);
    const Response there = points.respond(i, at);
    double change[3];
    bool acts = false; // most points do not
    for (int j = 0; j < c.dim; ++j) {
      change[j] = there.force[j] - here.force[j];
      acts = acts || change[j] != 0;
      for (int l = 0; l < c.dim; ++l) acts = acts || there.block[j][l] != 0;
    }
    if (!acts) return;
    for (LO k = 0; k < n; ++k) {
      sum[k] += inner_product(c, change, moves, i, k);
      for (LO l = 0; l < n; ++l)
        for (int j = 0; j < c.dim; ++j)
          sum[n + n * k + l] += moves(i, c.dim * k + j) * inner_product(c, there.block[j], moves, i, l);
    }
  }
};

/// Penetrations and slips of the points after the moves a_k d_k.
Places moved(const ContactNodes &c, const Places &from, const DeviceView<double **> &moves,
             const std::vector<double> &a)
{
  const Places at(c.size(), c.dim, from.e.extent(0) > 0);
  const auto coefficient = device_values(a, "rpc::contact::coefficients");
  const LO n = static_cast<LO>(a.size());
  Kokkos::parallel_for(
      "rpc::contact::places", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        Motion there = from(i);
        for (LO k = 0; k < n; ++k) move(c, moves, i, k, coefficient(k), there);
        at.set(i, there);
      });
  Kokkos::fence();
  return at;
}

/// (points, dim) The sum of direction_k times each move. [m]
DeviceView<double **> moves_along(const ContactNodes &c, const DeviceView<double **> &moves,
                                  const std::vector<double> &direction)
{
  const DeviceView<double **> sum("rpc::contact::moves", c.size(), c.dim);
  const auto coefficient = device_values(direction, "rpc::contact::coefficients");
  const LO n = static_cast<LO>(direction.size());
  Kokkos::parallel_for(
      "rpc::contact::moves_along", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (LO k = 0; k < n; ++k)
          for (int j = 0; j < c.dim; ++j) sum(i, j) += coefficient(k) * moves(i, c.dim * k + j);
      });
  Kokkos::fence();
  return sum;
}

class SubspaceModel : public SubspaceFunction
{
public:
  SubspaceModel(RCP<const Comm> comm, std::vector<double> at_0, std::vector<double> elastic, SmoothedPoints points,
                Places from, DeviceView<double **> moves)
      : comm_(std::move(comm)), at_0_(std::move(at_0)), elastic_(std::move(elastic)), points_(std::move(points)),
        from_(std::move(from)), moves_(std::move(moves))
  {
  }
  Value at(const std::vector<double> &a) const override
  {
    const std::size_t n = a.size();
    const SubspaceSums sums(points_, from_, moves_, device_values(a, "rpc::contact::coefficients"));
    std::vector<double> mine(n * (n + 1));
    const Kokkos::View<double *, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> result(mine.data(), mine.size());
    Kokkos::parallel_reduce("rpc::contact::subspace_model", device_range(points_.size()), sums, result);
    Kokkos::fence();
    const auto all = summed(*comm_, mine);
    Value value{at_0_, elastic_};
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t l = 0; l < n; ++l) value.gradient[k] += elastic_[n * k + l] * a[l];
      value.gradient[k] += all[k];
    }
    for (std::size_t k = 0; k < n * n; ++k) value.curvature[k] += all[n + k];
    return value;
  }

  std::unique_ptr<LineFunction> along(const std::vector<double> &a, const Value &at_a,
                                      const std::vector<double> &direction) const override
  {
    const std::size_t n = a.size();
    double slope = 0, curvature = 0;
    for (std::size_t k = 0; k < n; ++k) {
      slope += at_a.gradient[k] * direction[k];
      for (std::size_t l = 0; l < n; ++l) curvature += direction[k] * elastic_[n * k + l] * direction[l];
    }
    return std::make_unique<LineModel>(comm_, slope, curvature, points_, moved(points_.points, from_, moves_, a),
                                       moves_along(points_.points, moves_, direction));
  }

private:
  RCP<const Comm> comm_;
  std::vector<double> at_0_, elastic_;
  SmoothedPoints points_;
  Places from_;
  DeviceView<double **> moves_; // (points, directions dim)
};

} // namespace

std::unique_ptr<LineFunction> line_model(RCP<const Comm> comm, const double slope_at_0, const double elastic_curvature,
                                         const SmoothedPoints &points, const Vector &u, const Vector &d)
{
  const DeviceView<double **> moves("rpc::contact::moves", points.size(), points.points.dim);
  take_moves(points.points, d, 0, moves);
  return std::make_unique<LineModel>(std::move(comm), slope_at_0, elastic_curvature, points, Places(points.points, u),
                                     moves);
}

std::unique_ptr<SubspaceFunction> subspace_model(RCP<const Comm> comm, std::vector<double> at_0,
                                                 std::vector<double> elastic, const SmoothedPoints &points,
                                                 const Vector &u, const std::vector<RCP<const Vector>> &directions)
{
  const LO n = static_cast<LO>(directions.size());
  const DeviceView<double **> moves("rpc::contact::moves", points.size(), n * points.points.dim);
  for (LO k = 0; k < n; ++k) take_moves(points.points, *directions[k], k, moves);
  return std::make_unique<SubspaceModel>(std::move(comm), std::move(at_0), std::move(elastic), points,
                                         Places(points.points, u), moves);
}

} // namespace rpc::contact
