// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/multigrid.hpp"

#include "multigrid/gathered_solver.hpp"
#include "multigrid/guarded_solver.hpp"
#include "multigrid/one_thread_aggregates.hpp"
#include "rpc/core/message.hpp"
#include "rpc/core/muelu.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <MueLu_DirectSolver.hpp>
#include <MueLu_FactoryManager.hpp>
#include <MueLu_SingleLevelFactoryBase.hpp>
#include <MueLu_SmootherFactory.hpp>
#include <algorithm>
#include <exception>

namespace rpc::solver
{
namespace
{

using Translation = Teuchos::Array<LO>;

/// Nodes of unknowns in MueLu's format.
struct Nodes {
  RCP<const XpetraMap> map;
  RCP<Translation> of_unknown; // local node of a local unknown
};

/// Whether unknown k of a map's local node n has the gid size * (the node's gid) + k, for all of them on this rank.
bool node_by_node(const XpetraMap &unknowns, const LO size)
{
  if (unknowns.getIndexBase() != 0 || num_local(unknowns) % size != 0) return false;
  if (unknowns.isContiguous()) return num_local(unknowns) == 0 || unknowns.getMinGlobalIndex() % size == 0;
  const auto gids = local_gids(unknowns);
  for (Teuchos_Ordinal k = 0; k < gids.size(); ++k)
    if (gids[k] % size != k % size || gids[k] != gids[k - k % size] + k % size) return false;
  return true;
}

/// Collective.
Nodes nodes_of(const XpetraMap &unknowns, const LO size)
{
  Nodes nodes{Teuchos::null, rcp(new Translation(num_local(unknowns)))};
  LO n = 0;
  for (auto to = nodes.of_unknown->begin(); to != nodes.of_unknown->end(); ++n)
    for (LO k = 0; k < size; ++k) *to++ = n;
  using MapFactory = Xpetra::MapFactory<LO, GO, Node>;
  if (unknowns.isContiguous()) {
    nodes.map = MapFactory::Build(unknowns.lib(), unknowns.getGlobalNumElements() / size, num_local(unknowns) / size, 0,
                                  unknowns.getComm());
  } else {
    const auto gids = local_gids(unknowns);
    Teuchos::Array<GO> of_nodes(gids.size() / size);
    for (Teuchos_Ordinal k = 0; k < of_nodes.size(); ++k) of_nodes[k] = gids[size * k] / size;
    nodes.map = MapFactory::Build(unknowns.lib(), Teuchos::OrdinalTraits<Xpetra::global_size_t>::invalid(), of_nodes(),
                                  0, unknowns.getComm());
  }
  return nodes;
}

/// Stands in for MueLu's AmalgamationFactory, for one thread or for many.
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

/// Stand-ins for factories of one level.
void replace_factories(MueLu::FactoryManager<double, LO, GO, Node> &manager)
{
  if (muelu::takes_device_factories(manager)) {
    manager.SetFactory("UnAmalgamationInfo",
                       rcp(new NodeByNode<muelu::DeviceAmalgamationInfo, muelu::DeviceAmalgamation>));
    use_one_thread_aggregates(manager);
  } else {
    manager.SetFactory("UnAmalgamationInfo", rcp(new NodeByNode<muelu::HostAmalgamationInfo, muelu::HostAmalgamation>));
  }
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

using MueLusInterpreter = MueLu::ParameterListInterpreter<double, LO, GO, Node>;

/// MueLu's reading of a list, but for the patterns of matrix products, which hierarchies that reuse parts do not keep: MueLu leaves
/// exact zeros of a matrix out of them. Where such an entry is none any more, the rank that owns it would throw, and the others wait
/// for it. One rank alone keeps them: where it throws, the hierarchy is made anew, and else renewals cost a fifth less.
class Interpreter : public MueLusInterpreter
{
public:
  Interpreter(Teuchos::ParameterList &list, const RCP<const Comm> &comm) : MueLusInterpreter(list, comm)
  {
    if (comm->getSize() == 1) return;
    for (auto &[level, kept] : keep_)
      kept.erase(std::remove_if(
                     kept.begin(), kept.end(),
                     [](const auto &data) { return data.first == "AP reuse data" || data.first == "RAP reuse data"; }),
                 kept.end());
  }
};

/// A Tpetra multivector of the "user data" as MueLu takes it.
void wrap(Teuchos::ParameterList &user_data, const std::string &name)
{
  if (!user_data.isParameter(name)) return;
  const auto vectors = user_data.get<RCP<MultiVector>>(name);
  user_data.set(name, muelu::to_xpetra(vectors));
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
  Interpreter interpreter(plain, A->getComm());
  for (std::size_t level = 0; level < interpreter.getNumFactoryManagers(); ++level) {
    auto &manager = *Teuchos::rcp_dynamic_cast<MueLu::FactoryManager<double, LO, GO, Node>>(
        interpreter.GetFactoryManager(static_cast<int>(level)), true);
    replace_factories(manager);
    if (const auto solver = coarse_solver(*A, plain); !solver.is_null())
      manager.SetFactory("CoarseSolver", rcp(new MueLu::SmootherFactory<double, LO, GO, Node>(solver)));
  }
  const auto hierarchy = interpreter.CreateHierarchy();
  const RCP<XpetraMatrix> matrix = muelu::to_xpetra(A);
  hierarchy->setlib(Xpetra::UseTpetra);
  MueLu::HierarchyUtils<double, LO, GO, Node>::AddNonSerializableDataToHierarchy(interpreter, *hierarchy, user_data);
  hierarchy->GetLevel(0)->Set("A", matrix);
  hierarchy->SetProcRankVerbose(A->getComm()->getRank());
  interpreter.SetupHierarchy(*hierarchy);
  return rcp(new Multigrid(hierarchy));
}

bool renew_multigrid(const RCP<CrsMatrix> &A, RCP<Multigrid> &multigrid)
{
  try {
    MueLu::ReuseTpetraPreconditioner(A, *multigrid);
    return true;
  } catch (const std::exception &failure) { // on all ranks
    pass_on_out_of_memory(failure);
    multigrid = Teuchos::null;
    return false;
  }
}

} // namespace rpc::solver
