// SPDX-License-Identifier: BSD-3-Clause
#include "space_traction_fit.hpp"

#include "least_in_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

/// The quadratic function of the fit: x . H x/2 - f . x. The unknowns are the coefficients of tractions on facets, component by component; of a
/// pressure with hardening once more as many, by which these exceed the yield limit.
class FitInSpace
{
public:
  FitInSpace(const SpaceContact &c, const WantedInSpace &w)
      : c_(c), w_(w), n_(nodes_of_triangle(c.order)), unknowns_(n_ * c.facet.size())
  {
    for (int a = 0; a < n_; ++a) {
      OfTriangle at_nodes{};
      at_nodes[a] = 1;
      const OfTriangle shape = bernstein_of(c.order, at_nodes);
      for (int j = 0; j < n_; ++j) {
        mass_[a][j] = mean_product(c.order, a, j);
        for (int i = 0; i < n_; ++i) forces_[a][j] += shape[i] * mean_product(c.order, i, j);
      }
    }
    double area = 0;
    for (const double a : c.area) area += a;
    size_ = std::sqrt(2 * area / static_cast<double>(c.area.size()));
    list_hats();
    force_.resize(c.place.size());
    weighted_.resize(c.place.size());
    for (int k = 0; k < w.components && !plain(); ++k)
      for (auto *const values : {&t_, &h_}) (*values)[k].resize(unknowns_);
    const std::size_t blocks = w.components == 2 || w.rise > 0 ? 2 : 1;
    for (auto *const of_unknowns : {&f_, &scale_, &start_, &low_bound_, &high_bound_})
      of_unknowns->assign(blocks * unknowns_, 0.);
    apply_or_compare(start_, true, f_);
    for (double &f : f_) f = -f;
    Values near;
    for (int k = 0; k < w.components; ++k)
      for (const OfTriangle &of_facet : w.near[k])
        near[k].insert(near[k].end(), of_facet.begin(), of_facet.begin() + n_);
    reduce(near, start_);
    for (std::size_t e = 0; e < c.facet.size(); ++e)
      for (int i = 0; i < n_; ++i) set_bounds(e, i);
  }

  /// y <- H x.
  void apply(const std::vector<double> &x, std::vector<double> &y) { apply_or_compare(x, false, y); }
  /// y <- H x - f. Forces of the whole side weigh much: their difference is taken before.
  void gradient(const std::vector<double> &x, std::vector<double> &y) { apply_or_compare(x, true, y); }
  AlongSide tractions_of(const std::vector<double> &x)
  {
    expand(x);
    AlongSide all;
    for (int k = 0; k < w_.components; ++k)
      for (std::size_t e = 0; e < c_.facet.size(); ++e) {
        all[k].emplace_back();
        std::copy_n((plain() ? x : t_[k]).begin() + n_ * e, n_, all[k].back().begin());
      }
    return all;
  }
  const std::vector<double> &right_side() const { return f_; }
  const std::vector<double> &scale() const { return scale_; } ///< that makes about 1 of the diagonal
  const std::vector<double> &start() const { return start_; }
  const std::vector<double> &low() const { return low_bound_; }
  const std::vector<double> &high() const { return high_bound_; }

private:
  using Values = std::array<std::vector<double>, 2>; // (components; unknowns)
  /// Of one level: (points) the first of four hats, and what they are there; 0 where nothing can act.
  struct Hats {
    int intervals;
    bool of_points = true; // whether sums over points make them; else those of the level before
    std::vector<std::size_t> first;
    std::vector<std::array<double, 4>> weight;
    std::vector<double> hat; // work space
  };

  bool hardens() const { return w_.rise > 0; }
  /// Whether the unknowns are the coefficients of the traction.
  bool plain() const { return w_.components == 1 && !hardens(); }
  void apply_or_compare(const std::vector<double> &x, const bool compare, std::vector<double> &y)
  {
    n_ == 3 ? apply_of<3>(x, compare, y) : apply_of<6>(x, compare, y);
  }
  /// @tparam N  coefficients of a facet
  template <int N>
  void apply_of(const std::vector<double> &x, const bool compare, std::vector<double> &y)
  {
    expand(x);
    y.resize(x.size());
    for (int k = 0; k < w_.components; ++k) {
      const double *const t = plain() ? x.data() : t_[k].data();
      double *const h = plain() ? y.data() : h_[k].data();
      for (std::size_t i = 0; i < force_.size(); ++i) force_[i] = compare ? -w_.force[k][i] : 0;
      for (std::size_t e = 0; e < c_.facet.size(); ++e)
        for (int a = 0; a < N; ++a) {
          double sum = 0;
          for (int j = 0; j < N; ++j) sum += forces_[a][j] * t[N * e + j];
          force_[c_.point[e][a]] += c_.area[e] * sum;
        }
      for (std::size_t i = 0; i < force_.size(); ++i)
        if (!w_.free[i]) force_[i] = 0;
      add_weighted();
      for (std::size_t e = 0; e < c_.facet.size(); ++e) {
        const double of_mass = mass_weight(e), of_force = c_.area[e] / (c_.modulus * size_);
        for (int i = 0; i < N; ++i) {
          double near = 0, mass = 0, sum = 0;
          for (int a = 0; a < N; ++a) {
            sum += forces_[a][i] * weighted_[c_.point[e][a]];
            mass += mass_[i][a] * t[N * e + a];
            if (compare) near += mass_[i][a] * (near_weight(e) * w_.near[k][e][a] + c_.area[e] * w_.depth[k][e][a]);
          }
          h[N * e + i] = of_force * sum + of_mass * mass - near;
        }
      }
    }
    if (!plain()) reduce(h_, y);
    for (std::size_t q = 0; hardens() && q < unknowns_; ++q)
      y[unknowns_ + q] += beyond_weight(q / N) * x[unknowns_ + q];
  }
  /// t_ <- tractions from the unknowns.
  void expand(const std::vector<double> &x)
  {
    for (std::size_t q = 0; !plain() && q < unknowns_; ++q) {
      if (w_.components == 1) {
        t_[0][q] = x[q] + x[unknowns_ + q];
        continue;
      }
      const auto &d = w_.toward[q / n_][q % n_];
      t_[0][q] = d[0] * x[q] - d[1] * x[unknowns_ + q];
      t_[1][q] = d[1] * x[q] + d[0] * x[unknowns_ + q];
    }
  }
  /// The transpose.
  void reduce(const Values &t, std::vector<double> &x) const
  {
    for (std::size_t q = 0; q < unknowns_; ++q) {
      if (w_.components == 1) {
        x[q] = t[0][q];
        if (hardens()) x[unknowns_ + q] = t[0][q];
        continue;
      }
      const auto &d = w_.toward[q / n_][q % n_];
      x[q] = d[0] * t[0][q] + d[1] * t[1][q];
      x[unknowns_ + q] = d[0] * t[1][q] - d[1] * t[0][q];
    }
  }
  void set_bounds(const std::size_t e, const int i)
  {
    double own = 0;
    for (int j = 0; j < n_; ++j) own += forces_[j][i] * forces_[j][i];
    const double diagonal = c_.area[e] * c_.area[e] * own / (c_.modulus * size_) + mass_weight(e) * mass_[i][i];
    for (int k = 0; k < w_.components; ++k) {
      const std::size_t at = k * unknowns_ + n_ * e + i;
      low_bound_[at] = w_.low[k][e][i];
      high_bound_[at] = w_.high[k][e][i];
      scale_[at] = 1 / std::sqrt(diagonal);
    }
    if (hardens()) {
      const std::size_t at = unknowns_ + n_ * e + i;
      const double limit = w_.high[0][e][i];
      start_[at] = std::max(0., start_[at] - limit);
      high_bound_[at] = std::isinf(limit) ? 0 : std::numeric_limits<double>::infinity();
      scale_[at] = 1 / std::sqrt(diagonal + beyond_weight(e));
    }
    for (std::size_t at = n_ * e + i; at < start_.size(); at += unknowns_)
      start_[at] = std::clamp(start_[at], low_bound_[at], high_bound_[at]);
  }
  double near_weight(const std::size_t e) const
  {
    constexpr double share = 0.1; // how much the pressure at the nodes counts beside their forces
    return share * c_.area[e] * c_.area[e] / (c_.modulus * size_);
  }
  /// With the energy c p^2/2 of the foundation's springs.
  double mass_weight(const std::size_t e) const { return near_weight(e) + w_.spring * c_.area[e]; }
  /// Of the squares of what coefficients exceed the yield limit by: (p - xi)^2/(2 H) is convex, so that its integral is no larger.
  double beyond_weight(const std::size_t e) const { return c_.area[e] / (n_ * w_.rise); }
  /// Squares of intervals of hats on all levels, from about four nodes for each down to one for all.
  void list_hats()
  {
    std::array<double, 2> low{}, high{};
    int count = 0;
    for (int d = 0; d < 2; ++d) {
      low[d] = std::numeric_limits<double>::infinity();
      high[d] = -low[d];
    }
    for (std::size_t i = 0; i < c_.place.size(); ++i) {
      if (!w_.free[i]) continue;
      ++count;
      for (int d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], c_.place[i][d]);
        high[d] = std::max(high[d], c_.place[i][d]);
      }
    }
    std::array<double, 2> span{};
    for (int d = 0; d < 2; ++d) span[d] = high[d] - low[d];
    if (!(span[0] > 0 && span[1] > 0)) return;
    for (int n = static_cast<int>(std::sqrt(count)) / 2; n >= 1; n /= 2) {
      Hats level{n, levels_.empty() || levels_.back().intervals != 2 * n, {}, {}, {}};
      level.hat.resize(static_cast<std::size_t>(n + 1) * (n + 1));
      if (level.of_points) {
        level.first.resize(c_.place.size());
        level.weight.resize(c_.place.size());
      }
      for (std::size_t i = 0; level.of_points && i < c_.place.size(); ++i) {
        if (!w_.free[i]) continue;
        int k[2];
        double x[2];
        for (int d = 0; d < 2; ++d) {
          x[d] = n * (c_.place[i][d] - low[d]) / span[d];
          k[d] = std::clamp(static_cast<int>(x[d]), 0, n - 1);
          x[d] -= k[d];
        }
        level.first[i] = static_cast<std::size_t>(k[0]) * (n + 1) + k[1];
        level.weight[i] = {(1 - x[0]) * (1 - x[1]), (1 - x[0]) * x[1], x[0] * (1 - x[1]), x[0] * x[1]};
      }
      levels_.push_back(level);
    }
  }
  /// Calls with the place of each hat of a level, that of a hat which it holds of twice as many intervals, and how much of that.
  template <class Visit>
  static void for_finer(const int intervals, const Visit &visit)
  {
    const int n = 2 * intervals + 1;
    for (int k = 0; k <= intervals; ++k)
      for (int l = 0; l <= intervals; ++l)
        for (int i = std::max(0, 2 * k - 1); i < std::min(n, 2 * k + 2); ++i)
          for (int j = std::max(0, 2 * l - 1); j < std::min(n, 2 * l + 2); ++j)
            visit(k * (intervals + 1) + l, i * n + j, (i == 2 * k ? 1 : 0.5) * (j == 2 * l ? 1 : 0.5));
  }
  /// weighted_ <- S force_, with S the sum over all levels of the products with hats, and the nodes themselves. Of twice as many intervals as the
  /// next level has, hats of that level are sums of those of this one.
  void add_weighted()
  {
    constexpr double of_all = 100; // of the force and moments of the whole side, squared
    weighted_ = force_;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      Hats &level = levels_[l];
      if (level.of_points) {
        const std::size_t n = level.intervals + 1, step[4] = {0, 1, n, n + 1};
        level.hat.assign(level.hat.size(), 0.);
        for (std::size_t i = 0; i < force_.size(); ++i)
          for (int k = 0; k < 4; ++k) level.hat[level.first[i] + step[k]] += level.weight[i][k] * force_[i];
        continue;
      }
      level.hat.assign(level.hat.size(), 0.);
      const std::vector<double> &finer = levels_[l - 1].hat;
      for_finer(level.intervals,
                [&](const int at, const int fine, const double part) { level.hat[at] += part * finer[fine]; });
    }
    for (std::size_t l = levels_.size(); l-- > 0;) {
      Hats &level = levels_[l];
      for (double &of_hat : level.hat) of_hat *= level.intervals == 1 ? of_all : 1;
      if (l + 1 < levels_.size() && !levels_[l + 1].of_points)
        for_finer(levels_[l + 1].intervals, [&](const int at, const int fine, const double part) {
          level.hat[fine] += part * levels_[l + 1].hat[at];
        });
      if (!level.of_points) continue;
      const std::size_t n = level.intervals + 1, step[4] = {0, 1, n, n + 1};
      for (std::size_t i = 0; i < force_.size(); ++i)
        for (int k = 0; k < 4; ++k) weighted_[i] += level.weight[i][k] * level.hat[level.first[i] + step[k]];
    }
  }

  const SpaceContact &c_;
  const WantedInSpace &w_;
  int n_; // coefficients of a facet
  std::size_t unknowns_;
  std::array<OfTriangle, 6> forces_{},
      mass_{};      // means of products of shape functions and Bernstein polynomials, and of these
  double size_ = 0; // of facets [m]
  std::vector<Hats> levels_;
  Values t_, h_;                         // work space where unknowns are no coefficients of the traction
  std::vector<double> force_, weighted_; // (points) work space
  std::vector<double> f_, scale_, start_, low_bound_, high_bound_;
};

} // namespace

AlongSide fitted_in_space(const SpaceContact &c, const WantedInSpace &wanted)
{
  FitInSpace fit(c, wanted);
  return fit.tractions_of(least_in_box(fit));
}

} // namespace rpc::bound
