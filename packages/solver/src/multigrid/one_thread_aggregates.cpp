// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/one_thread_aggregates.hpp"

#include <MueLu_SingleLevelFactoryBase.hpp>
#include <algorithm>

namespace rpc::solver
{

#ifdef RPC_MUELU_IS_DOUBLED

namespace
{

using muelu::DeviceAggregates;
using muelu::DeviceAggregation;
using muelu::DeviceGraph;
using muelu::HostAggregates;
using muelu::HostAggregation;

/// A host copy as MueLu takes it.
template <class View>
auto host_array(const View &device)
{
  const auto host = to_host(device);
  return Teuchos::arcpWithEmbeddedObj(host.data(), 0, host.extent(0), host, false);
}

/// The nodes' graph for MueLu's factories of one thread, from that for many.
class GraphOnHost : public MueLu::SingleLevelFactoryBase
{
public:
  RCP<const Teuchos::ParameterList> GetValidParameterList() const override
  {
    const auto valid = Teuchos::parameterList();
    for (const char *name : {"A", "Graph"}) valid->set<RCP<const MueLu::FactoryBase>>(name, Teuchos::null);
    return valid;
  }
  void DeclareInput(MueLu::Level &level) const override
  {
    Input(level, "A");
    Input(level, "Graph");
  }
  void Build(MueLu::Level &level) const override
  {
    const auto A = Get<RCP<XpetraMatrix>>(level, "A");
    const auto graph = Get<RCP<DeviceGraph>>(level, "Graph");
    const LO size = A->GetFixedBlockSize();
    const auto offsets = host_array(graph->getRowPtrs());
    const auto columns = host_array(graph->getEntries());
    const Teuchos::ArrayRCP<LO> rows(offsets.size());
    std::copy(offsets.begin(), offsets.end(), rows.begin());
    const RCP<muelu::HostGraphBase> host = rcp(new muelu::HostGraph(rows, Teuchos::arcp_const_cast<LO>(columns),
                                                                    graph->GetDomainMap(), graph->GetImportMap()));
    host->SetBoundaryNodeMap(prescribed_nodes(*A, size));
    Set(level, "Graph", host);
    Set(level, "DofsPerNode", size);
  }

private:
  /// Nodes without couplings: they belong to no aggregate.
  static Teuchos::ArrayRCP<const bool> prescribed_nodes(const XpetraMatrix &A, const LO size)
  {
    const auto rows = to_host(muelu::DeviceUtilities::DetectDirichletRows(A));
    Teuchos::ArrayRCP<bool> nodes(rows.extent(0) / size, true);
    for (std::size_t row = 0; row < rows.extent(0); ++row)
      if (!rows(row)) nodes[row / size] = false;
    return nodes;
  }
};

/// MueLu's aggregates of one thread, for its factories for many: they are the same on all backends and in all runs, more even
/// than those by coloring (12 CG iterations on the beam instead of 15 to 20), and take no longer: 13.2 colors on one thread too.
class AggregatesOfOneThread : public MueLu::SingleLevelFactoryBase
{
public:
  AggregatesOfOneThread(const Teuchos::ParameterList &options, const RCP<const MueLu::FactoryBase> &device_graph)
      : host_(rcp(new HostAggregation))
  {
    const auto graph = rcp(new GraphOnHost);
    graph->SetFactory("Graph", device_graph);
    host_->SetFactory("Graph", graph);
    host_->SetFactory("DofsPerNode", graph);
    Teuchos::ParameterList taken;
    const auto valid = host_->GetValidParameterList();
    for (auto it = options.begin(); it != options.end(); ++it)
      if (options.name(it).rfind("aggregation: ", 0) == 0 && valid->isParameter(options.name(it)))
        taken.setEntry(options.name(it), options.entry(it));
    host_->SetParameterList(taken);
  }
  void DeclareInput(MueLu::Level &level) const override { level.DeclareInput("Aggregates", host_.get(), this); }
  void Build(MueLu::Level &level) const override
  {
    const auto from = level.Get<RCP<HostAggregates>>("Aggregates", host_.get());
    const auto to = rcp(new DeviceAggregates(from->GetMap()));
    to->SetNumAggregates(from->GetNumAggregates());
    copy(*from->GetVertex2AggId(), *to->GetVertex2AggIdNonConst());
    copy(*from->GetProcWinner(), *to->GetProcWinnerNonConst());
    to->AggregatesCrossProcessors(false);
    to->ComputeAggregateSizes(true);
    Set(level, "Aggregates", to);
  }

private:
  using Indices = Xpetra::MultiVector<LO, LO, GO, Node>;
  static void copy(const Indices &from, Indices &to)
  {
    const auto values = from.getData(0);
    const auto view = to.getDeviceLocalView(Xpetra::Access::OverwriteAll);
    const auto column = Kokkos::subview(view, Kokkos::ALL(), 0);
    const Kokkos::View<const LO *, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host(values.getRawPtr(), values.size());
    Kokkos::deep_copy(column, host);
  }

  RCP<HostAggregation> host_;
};

} // namespace

void use_one_thread_aggregates(MueLu::FactoryManager<double, LO, GO, Node> &manager)
{
  using Teuchos::rcp_const_cast;
  using Teuchos::rcp_dynamic_cast;
  const auto threaded = rcp_dynamic_cast<const DeviceAggregation>(manager.GetFactory("Aggregates"));
  if (threaded.is_null()) return;
  const Teuchos::ParameterList &options = threaded->GetParameterList();
  if (!options.get<bool>("aggregation: deterministic")) return;
  const RCP<MueLu::FactoryBase> aggregates = rcp(new AggregatesOfOneThread(options, manager.GetFactory("Graph")));
  manager.SetFactory("Aggregates", aggregates);
  for (const char *user : {"Ptent", "CoarseMap"}) // MueLu has told them already
    rcp_const_cast<MueLu::Factory>(rcp_dynamic_cast<const MueLu::Factory>(manager.GetFactory(user), true))
        ->SetFactory("Aggregates", aggregates);
}

#else

void use_one_thread_aggregates(MueLu::FactoryManager<double, LO, GO, Node> &) {}

#endif

} // namespace rpc::solver
