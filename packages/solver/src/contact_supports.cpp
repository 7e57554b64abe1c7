#include "contact_supports.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <TpetraExt_MatrixMatrix.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>
#include <algorithm>

namespace rpc::solver
{
namespace
{

const auto to_be_counted = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();

/// The contact nodes that have an entry at a node of this rank, by gid; collective.
RCP<const Map> near_contact(const RCP<const CrsMatrix> &supports)
{
  using Transposer = Tpetra::RowMatrixTransposer<double, LO, GO, Node>;
  const auto transpose = Transposer(supports).createTranspose();
  const Map &columns = *transpose->getColMap();
  Teuchos::Array<GO> gids;
  for (LO c = 0; c < num_local(columns); ++c) gids.push_back(columns.getGlobalElement(c));
  std::sort(gids.begin(), gids.end());
  return rcp(new Map(to_be_counted, gids(), 0, columns.getComm()));
}

} // namespace

RCP<const CrsMatrix> contact_supports(const DeviceView<LO *> &nodes, const RCP<const Map> &mesh)
{
  const auto node = to_host(nodes);
  const auto contact = rcp(new Map(to_be_counted, node.extent(0), 0, mesh->getComm()));
  const auto S = rcp(new CrsMatrix(contact, 1));
  for (std::size_t c = 0; c < node.extent(0); ++c)
    S->insertGlobalValues(contact->getGlobalElement(static_cast<LO>(c)),
                          Teuchos::tuple(mesh->getGlobalElement(node(c))), Teuchos::tuple(1.));
  S->fillComplete(mesh, contact);
  return S;
}

RCP<const CrsMatrix> coarser(const CrsMatrix &supports, const CrsMatrix &interpolation)
{
  const auto S = rcp(new CrsMatrix(supports.getRowMap(), 0));
  Tpetra::MatrixMatrix::Multiply(supports, false, interpolation, false, *S);
  return S;
}

NearSupports near_supports(const RCP<const CrsMatrix> &supports)
{
  NearSupports near;
  near.importer = rcp(new Import(supports->getRowMap(), near_contact(supports)));
  const auto rows = Tpetra::importAndFillCompleteCrsMatrix(supports, *near.importer);
  const auto matrix = rows->getLocalMatrixDevice();
  const auto begin = to_host(matrix.graph.row_map);
  const auto column = to_host(matrix.graph.entries);
  const auto value = to_host(matrix.values);
  const Map &columns = *rows->getColMap();
  for (LO c = 0; c < matrix.numRows(); ++c) {
    for (auto e = begin(c); e < begin(c + 1); ++e) {
      near.node.push_back(columns.getGlobalElement(column(e)));
      near.weight.push_back(value(e));
    }
    near.begin.push_back(near.node.size());
  }
  return near;
}

} // namespace rpc::solver
