// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoint.hpp"

#include "run_scene.hpp"
#include "scratch_file.hpp"

#include <filesystem>
#include <gtest/gtest.h>

namespace checkpoint_test
{
namespace
{

using namespace rpc;

/// (owned nodes; n) numbers that differ by node and column.
RCP<const MultiVector> columns(const fem::Discretization &d, const int n, const double first)
{
  const auto values = rcp(new MultiVector(d.mesh->owned_nodes, n));
  const auto to = values->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO node = 0; node < d.mesh->num_owned_nodes(); ++node)
    for (int k = 0; k < n; ++k) to(node, k) = first + 10 * k + 1e-3 * static_cast<double>(d.mesh->node_id(node));
  return values;
}
void expect_equal(const RCP<const MultiVector> &a, const RCP<const MultiVector> &b)
{
  ASSERT_FALSE(a.is_null());
  ASSERT_EQ(a->getNumVectors(), b->getNumVectors());
  const auto x = a->getLocalViewHost(Tpetra::Access::ReadOnly), y = b->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t n = 0; n < x.extent(0); ++n)
    for (std::size_t k = 0; k < x.extent(1); ++k) EXPECT_EQ(x(n, k), y(n, k));
}

TEST(Checkpoint, HoldsWhatTheLawHasAndDentsOfFoundations)
{
  const Scene scene = read_scene(std::string(RPC_TEST_DECKS) + "/../../../input/beam.xml",
                                 {"Steps->Times={1, 2}", "Mesh->Cells={20, 4}"});
  const auto comm = Tpetra::getDefaultComm();
  const auto d =
      fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_mesh(scene.mesh, comm)), scene.model.kinematics);
  const test::ScratchFile file("scratch", "");
  const std::string folder = std::filesystem::path(file.path()).parent_path().string();
  for (const bool tangential : {true, false}) {
    analysis::HistoryState state;
    state.discretization = d;
    state.mesh_options = scene.mesh;
    state.before.emplace();
    for (analysis::Memory *const memory : {&state.last, &*state.before}) {
      const double first = memory == &state.last ? 1 : 100;
      memory->time = memory == &state.last ? 1 : 0.5;
      memory->displacement = rcp(new Vector(d.owned_dofs));
      memory->pressure = columns(d, 1, first);
      memory->dent = columns(d, 1, first + 1);
      memory->gap = columns(d, 1, first + 2);
      if (tangential) memory->tangential = columns(d, 2, first + 3);
    }
    auto sheet = std::make_shared<contact::DentSheet>(); // of this rank
    sheet->facet = d.mesh->element.facet();
    sheet->place = sheet->direction = {{1. + comm->getRank(), 2, 0}, {3, 0.1, 0}};
    sheet->dent = {0.5, 0.25};
    sheet->facet_node = {0, 1};
    state.last.foundations = {{{sheet}, 0.5, 0.75}};
    state.records.resize(1);
    state.records[0].time = 1;
    Checkpoints(scene, false, "", folder).write(state);
    const auto found =
        Checkpoints(scene, true, (std::filesystem::path(folder) / (scene.name + ".checkpoint-000001.e")).string(),
                    folder)
            .resume(comm);
    ASSERT_TRUE(found && found->before);
    expect_equal(found->last.pressure, state.last.pressure);
    expect_equal(found->last.dent, state.last.dent);
    expect_equal(found->last.gap, state.last.gap);
    expect_equal(found->before->pressure, state.before->pressure);
    ASSERT_EQ(found->last.foundations.size(), 1u);
    EXPECT_EQ(found->last.foundations[0].volume, 0.75);
    ASSERT_EQ(found->last.foundations[0].sheets.size(), 1u);
    EXPECT_EQ(found->last.foundations[0].sheets[0]->place, sheet->place);
    EXPECT_EQ(found->last.foundations[0].sheets[0]->dent, sheet->dent);
    EXPECT_EQ(found->last.tangential.is_null(), !tangential);
    if (!tangential) continue;
    expect_equal(found->last.tangential, state.last.tangential);
    expect_equal(found->before->tangential, state.before->tangential);
  }
}

} // namespace
} // namespace checkpoint_test
