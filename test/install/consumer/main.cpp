#include <Tpetra_Core.hpp>
#include <iostream>
#include <rpc/mesh/box.hpp>

int main(int argc, char **argv)
{
  const Tpetra::ScopeGuard scope(&argc, &argv);
  rpc::mesh::BoxOptions options;
  options.lower = {0, 0};
  options.upper = {5, 3};
  options.cells = {5, 3};
  const rpc::mesh::Mesh mesh = rpc::mesh::make_box(options, Tpetra::getDefaultComm());
  std::cout << "nodes: " << mesh.owned_nodes->getGlobalNumElements() << std::endl;
}
