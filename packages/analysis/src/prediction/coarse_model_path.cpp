// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/coarse_model.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/contact/law/interior.hpp"
#include "rpc/core/headway.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::analysis
{
/// The interior path of the model: a point has v = v_i + moved - (p - p_i)/k on it.             (5.15) to (5.20), (5.8f)
class CoarseModel::Path
{
public:
  /// Begins at x, which moves with it.
  Path(CoarseModel &model, Unknowns &x)
      : model_(model), x_(x), moved_(model.points_moved(x)), at_(size()), change_(size()), aim_(size()),
        pressure_(size())
  {
    system_.stiffness.resize(size());
    double force = 0, force_there = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double weight = model_.data_[i].weight;
      area_ += weight;
      pairs_ += (contact::can_yield(law(i)) ? 2 : 1) * weight;
      force += weight * std::max(model_.p_[i], 0.);
      force_there += weight * model_.pressure(i, moved_[i]);
      length_ = std::max(length_, std::abs(model_.v_[i] + moved_[i]));
    }
    load_ = contact::interior_rules.above_start * (force > 0 ? force : force_there) / area_;
  }

  /// @return whether it has come near the solution
  bool follow()
  {
    if (!(load_ > 0 && length_ > 0)) return false;
    join();
    Headway lengths({1, contact::interior_rules.many_short_steps - 1});
    for (int step = 0; step < solver::newton_rules.most_inner_steps; ++step) {
      const double t = advance();
      if (!(t > 0)) return false;
      const double gap = products_ / (load_ * area_ * length_);
      if (gap <= path_rules.model_gap) return true;
      if (lengths.take(!(t < contact::interior_rules.short_step)) != Headway::Answer::stuck) continue;
      lengths.start_over();
      load_ *= contact::interior_rules.more_pressure;
      join();
    }
    return false;
  }

private:
  std::size_t size() const { return model_.data_.size(); }
  const contact::Foundation &law(const std::size_t i) const { return model_.data_[i].law; }

  /// From the present x, with the present load.                                                                     (5.16)
  void join()
  {
    mu_ = contact::interior_rules.first_mu * load_ * length_;
    for (std::size_t i = 0; i < size(); ++i)
      at_[i] = contact::join_path(load_, model_.v_[i] + moved_[i], mu_,
                                  contact::interior_rules.start_slope * load_ / length_, law(i));
  }

  /// The changes for the targets, and the part of them that keeps all points inside.                        (5.17), (5.19)
  double aimed()
  {
    for (std::size_t i = 0; i < size(); ++i) {
      const ModelPoint &point = model_.data_[i];
      const double v = model_.v_[i] + moved_[i] - (at_[i].pressure - model_.p_[i]) / point.stiffness;
      pressure_[i] = at_[i].pressure + system_.stiffness[i] * contact::linear_excess(at_[i], v, aim_[i], point.law);
    }
    d_ = model_.direction(system_, model_.gradient(elastic_, pressure_));
    const std::vector<double> along = model_.points_moved(d_);
    double longest = 1 / contact::interior_rules.to_boundary;
    for (std::size_t i = 0; i < size(); ++i) {
      const double dp = pressure_[i] - at_[i].pressure + system_.stiffness[i] * along[i];
      change_[i] = contact::linear_change(at_[i], dp, aim_[i], law(i));
      longest = std::min(longest, contact::longest_step(at_[i], change_[i], law(i)));
    }
    return contact::interior_rules.to_boundary * longest;
  }

  /// A step, predictor and corrector. @return its length; 0: there is no factor
  double advance()
  {
    for (std::size_t i = 0; i < size(); ++i)
      system_.stiffness[i] = 1 / (contact::linear_compliance(at_[i], law(i)) + 1 / model_.data_[i].stiffness);
    if (!model_.factorize(system_)) return 0;
    elastic_ = model_.elastic_forces(x_);
    aim_.assign(size(), {0, 0});
    const double part = aimed(), mu = contact::aimed_mu(mu_, part);
    for (std::size_t i = 0; i < size(); ++i) aim_[i] = contact::corrected_target(change_[i], mu, part, law(i));
    const double t = aimed();
    x_.move(t, d_);
    moved_ = model_.points_moved(x_);
    products_ = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      at_[i] = contact::moved(at_[i], t, change_[i]);
      products_ += model_.data_[i].weight * contact::complementarity(at_[i], law(i));
    }
    mu_ = products_ / pairs_;
    return t;
  }

  CoarseModel &model_;
  Unknowns &x_;
  std::vector<double> moved_;                  // (points) by x
  std::vector<contact::InteriorPoint> at_;     // (points)
  std::vector<contact::InteriorPoint> change_; // (points) of the step
  std::vector<contact::InteriorTarget> aim_;   // (points) its targets
  std::vector<double> pressure_;               // (points) of the linearized law, for no change of x [Pa]
  System system_;
  Unknowns elastic_, d_;
  double load_ = 0, length_ = 0; // pressure [Pa] and displacement [m] that tell what is small
  double area_ = 0, pairs_ = 0;  // sums of weights, once for each pair
  double mu_ = 0, products_ = 0; // of pairs, the latter in all [J/m^2], [J]
};

/// @return whether x has come near the solution
bool CoarseModel::follow_path(Unknowns &x)
{
  return Path(*this, x).follow();
}

} // namespace rpc::analysis
