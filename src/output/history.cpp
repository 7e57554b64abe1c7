#include "output/history.hpp"

#include "output/quantities.hpp"
#include "rpc/io/contact_csv.hpp"

#include <sstream>

namespace rpc
{
namespace
{

/// The counts of a step that are columns, in their places.
auto count_columns(const ResultScope &scope)
{
  std::vector<Quantity<analysis::StepRecord, int>> counts(analysis::step_parts.begin(), analysis::step_parts.end());
  counts.insert(counts.end(), analysis::step_work.begin(), analysis::step_work.end());
  return history_columns(counts, scope);
}

} // namespace

std::string history_text(const Scene &scene, const analysis::Solution &s)
{
  const int dim = s.discretization.dim();
  const std::string axes = "xyz";
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  const auto energies = history_columns(analysis::energy_quantities, scope);
  const auto contact = history_columns(contact::contact_quantities, scope);
  const auto counts = count_columns(scope);
  std::ostringstream text;
  text.precision(17);
  text << "time";
  write_names(text, energies, scope);
  write_names(text, contact, scope);
  for (int c = 0; c < dim; ++c) text << ",contact_force_" << axes[c];
  for (const auto &condition : scene.model.dirichlet)
    for (const char *const what : {"_displacement_", "_reaction_"})
      for (int c = 0; c < dim; ++c) text << ',' << io::csv_quoted(condition.name + what + axes[c]);
  write_names(text, counts, scope);
  text << ",seconds\n";
  for (const analysis::StepRecord &step : s.history) {
    text << step.time;
    write_values(text, energies, step.energies);
    write_values(text, contact, step.contact);
    for (int c = 0; c < dim; ++c) text << ',' << step.contact.force[c];
    for (std::size_t k = 0; k < step.reactions.size(); ++k) {
      for (int c = 0; c < dim; ++c) text << ',' << step.displacements[k][c];
      for (int c = 0; c < dim; ++c) text << ',' << step.reactions[k][c];
    }
    write_values(text, counts, step);
    text << ',' << step.seconds << '\n';
  }
  return text.str();
}

} // namespace rpc
