#include "multigrid.hpp"

#include "gathered_solver.hpp"
#include "guarded_solver.hpp"
#include "rpc/core/muelu.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <MueLu_DirectSolver.hpp>
#include <MueLu_FactoryManager.hpp>
#include <MueLu_SingleLevelFactoryBase.hpp>
#include <MueLu_SmootherFactory.hpp>
#ifdef RPC_MUELU_IS_DOUBLED
#include <MueLu_LWGraph.hpp>
#include <MueLu_LWGraph_kokkos.hpp>
#endif
#include <algorithm>

namespace rpc::solver
{
namespace
{

using XpetraMap = Xpetra::Map<LO, GO, Node>;
using Translation = Teuchos::Array<LO>;

/// Nodes of unknowns, as MueLu wants them told.
struct Nodes {
  RCP<const XpetraMap> map;
  RCP<Translation> of_unknown; // local node of a local unknown
};

/// Whether unknown k of a map's local node n has the gid size * (the node's gid) + k, for all of them on this rank.
bool node_by_node(const XpetraMap &unknowns, const LO size)
{
  if (unknowns.getIndexBase() != 0 || unknowns.getNodeNumElements() % size != 0) return false;
  if (unknowns.isContiguous()) return unknowns.getNodeNumElements() == 0 || unknowns.getMinGlobalIndex() % size == 0;
  const auto gids = unknowns.getNodeElementList();
  for (Teuchos_Ordinal k = 0; k < gids.size(); ++k)
    if (gids[k] % size != k % size || gids[k] != gids[k - k % size] + k % size) return false;
  return true;
}

/// Collective.
Nodes nodes_of(const XpetraMap &unknowns, const LO size)
{
  Nodes nodes{Teuchos::null, rcp(new Translation(unknowns.getNodeNumElements()))};
  LO n = 0;
  for (auto to = nodes.of_unknown->begin(); to != nodes.of_unknown->end(); ++n)
    for (LO k = 0; k < size; ++k) *to++ = n;
  using MapFactory = Xpetra::MapFactory<LO, GO, Node>;
  if (unknowns.isContiguous()) {
    nodes.map = MapFactory::Build(unknowns.lib(), unknowns.getGlobalNumElements() / size,
                                  unknowns.getNodeNumElements() / size, 0, unknowns.getComm());
  } else {
    const auto gids = unknowns.getNodeElementList();
    Teuchos::Array<GO> of_nodes(gids.size() / size);
    for (Teuchos_Ordinal k = 0; k < of_nodes.size(); ++k) of_nodes[k] = gids[size * k] / size;
    nodes.map = MapFactory::Build(unknowns.lib(), Teuchos::OrdinalTraits<Xpetra::global_size_t>::invalid(), of_nodes(),
                                  0, unknowns.getComm());
  }
  return nodes;
}

/// Stands in for MueLu's AmalgamationFactory or AmalgamationFactory_kokkos.
template <class Info, class Original>
class NodeByNode : public MueLu::SingleLevelFactoryBase
{
public:
  RCP<const Teuchos::ParameterList> GetValidParameterList() const override { return original_.GetValidParameterList(); }
  void DeclareInput(MueLu::Level &level) const override { Input(level, "A"); }

  void Build(MueLu::Level &level) const override
  {
    const auto A = Get<RCP<XpetraMatrix>>(level, "A");
    const LO size = A->GetFixedBlockSize();
    const XpetraMap &rows = *A->getRowMap(), &columns = *A->getColMap();
    const bool simple = size > 1 && node_by_node(rows, size) && node_by_node(columns, size);
    if (min_all(*rows.getComm(), simple ? 1 : 0) == 0) {
      Set(level, "UnAmalgamationInfo", by_muelu(*A, size));
      return;
    }
    const Nodes row_nodes = nodes_of(rows, size);
    const Nodes column_nodes = A->getRowMap() == A->getColMap() ? row_nodes : nodes_of(columns, size);
    Set(level, "UnAmalgamationInfo", info(*A, row_nodes, column_nodes, size));
  }

private:
  static RCP<Info> info(const XpetraMatrix &A, const Nodes &rows, const Nodes &columns, const LO size)
  {
    return rcp(
        new Info(rows.of_unknown, columns.of_unknown, rows.map, columns.map, A.getColMap(), size, 0, -1, 0, size));
  }
  /// In MueLu's way, for any other numbering; collective.
  static RCP<Info> by_muelu(const XpetraMatrix &A, const LO size)
  {
    if (size == 1) return info(A, {A.getRowMap(), Teuchos::null}, {A.getColMap(), Teuchos::null}, 1);
    Nodes rows{Teuchos::null, rcp(new Translation)}, columns{Teuchos::null, rcp(new Translation)};
    Original::AmalgamateMap(*A.getRowMap(), A, rows.map, *rows.of_unknown);
    Original::AmalgamateMap(*A.getColMap(), A, columns.map, *columns.of_unknown);
    return info(A, rows, columns, size);
  }

  Original original_;
};

#ifdef RPC_MUELU_IS_DOUBLED

using DeviceGraph = MueLu::LWGraph_kokkos<LO, GO, Node>;
using HostGraph = MueLu::LWGraph<LO, GO, Node>;
using muelu::DeviceAggregates;
using muelu::DeviceAggregation;
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
    const RCP<MueLu::GraphBase<LO, GO, Node>> host =
        rcp(new HostGraph(rows, Teuchos::arcp_const_cast<LO>(columns), graph->GetDomainMap(), graph->GetImportMap()));
    host->SetBoundaryNodeMap(prescribed_nodes(*A, size));
    Set(level, "Graph", host);
    Set(level, "DofsPerNode", size);
  }

private:
  /// Nodes whose rows have nothing beside the diagonal: no aggregate takes them.
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

/// Puts the aggregates in the place of those that many threads would make, unless the user wants these.
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

#endif

/// Stand-ins for factories of one level.
void replace_factories(MueLu::FactoryManager<double, LO, GO, Node> &manager)
{
#ifdef RPC_MUELU_IS_DOUBLED
  if (manager.GetKokkosRefactor()) {
    manager.SetFactory("UnAmalgamationInfo",
                       rcp(new NodeByNode<muelu::DeviceAmalgamationInfo, muelu::DeviceAmalgamation>));
    use_one_thread_aggregates(manager);
    return;
  }
#endif
  manager.SetFactory("UnAmalgamationInfo", rcp(new NodeByNode<muelu::HostAmalgamationInfo, muelu::HostAmalgamation>));
}

/// What solves on the coarsest level of several ranks, where the user has not said it: none on one rank.
RCP<CoarseSolver> coarse_solver(const CrsMatrix &A, const Teuchos::ParameterList &list)
{
  if (A.getComm()->getSize() == 1 || list.isParameter("coarse: type")) return Teuchos::null;
  if (!muelu::has_repartitioning) return rcp(new GatheredSolver);
  if (list.isType<std::string>("verbosity")) // what MueLu does only later, when it sets up the hierarchy
    MueLu::VerboseObject::SetDefaultVerbLevel(MueLu::toVerbLevel(list.get<std::string>("verbosity")));
  return rcp(new GuardedSolver(MueLu::DirectSolver<double, LO, GO, Node>().Copy()));
}

/// A Tpetra multivector of the "user data" as MueLu takes it.
void wrap(Teuchos::ParameterList &user_data, const std::string &name)
{
  if (!user_data.isParameter(name)) return;
  const auto vectors = user_data.get<RCP<MultiVector>>(name);
  user_data.set(name, RCP<XpetraVectors>(MueLu::TpetraMultiVector_To_XpetraMultiVector<double, LO, GO, Node>(vectors)));
}

} // namespace

RCP<Multigrid> make_multigrid(const RCP<CrsMatrix> &A, Teuchos::ParameterList list)
{
  if (list.isSublist("Hierarchy") || list.isParameter("parameterlist: syntax"))
    return MueLu::CreateTpetraPreconditioner(RCP<Operator>(A), list);
  wrap(list.sublist("user data"), "Coordinates");
  wrap(list.sublist("user data"), "Nullspace");
  Teuchos::ParameterList plain, user_data;
  MueLu::ExtractNonSerializableData(list, plain, user_data);
  MueLu::ParameterListInterpreter<double, LO, GO, Node> interpreter(plain, A->getComm());
  for (std::size_t level = 0; level < interpreter.getNumFactoryManagers(); ++level) {
    auto &manager = *Teuchos::rcp_dynamic_cast<MueLu::FactoryManager<double, LO, GO, Node>>(
        interpreter.GetFactoryManager(static_cast<int>(level)), true);
    replace_factories(manager);
    if (const auto solver = coarse_solver(*A, plain); !solver.is_null())
      manager.SetFactory("CoarseSolver", rcp(new MueLu::SmootherFactory<double, LO, GO, Node>(solver)));
  }
  const auto hierarchy = interpreter.CreateHierarchy();
  const RCP<XpetraMatrix> matrix = MueLu::TpetraCrs_To_XpetraMatrix<double, LO, GO, Node>(A);
  hierarchy->setlib(Xpetra::UseTpetra);
  MueLu::HierarchyUtils<double, LO, GO, Node>::AddNonSerializableDataToHierarchy(interpreter, *hierarchy, user_data);
  hierarchy->GetLevel(0)->Set("A", matrix);
  hierarchy->SetProcRankVerbose(A->getComm()->getRank());
  interpreter.SetupHierarchy(*hierarchy);
  return rcp(new Multigrid(hierarchy));
}

void renew_multigrid(const RCP<CrsMatrix> &A, Multigrid &multigrid)
{
  MueLu::ReuseTpetraPreconditioner(A, multigrid);
}

} // namespace rpc::solver
