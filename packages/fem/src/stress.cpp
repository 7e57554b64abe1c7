#include "rpc/fem/stress.hpp"

#include "kernels.hpp"

namespace rpc::fem
{
namespace
{

/// Stress components in the order of stress_names, without von Mises.
template <int Dim>
struct Voigt {
  static constexpr int size = Dim == 2 ? 3 : 6;
  static KOKKOS_INLINE_FUNCTION int row(const int k)
  {
    constexpr int r2[] = {0, 1, 0}, r3[] = {0, 1, 2, 0, 1, 0};
    return Dim == 2 ? r2[k % 3] : r3[k];
  }
  static KOKKOS_INLINE_FUNCTION int col(const int k)
  {
    constexpr int c2[] = {0, 1, 1}, c3[] = {0, 1, 2, 1, 2, 2};
    return Dim == 2 ? c2[k % 3] : c3[k];
  }
};

/// sum(node, k) += int N_a sigma_k, volume(node) += int N_a.
template <int Dim, int Nodes>
struct ProjectStress {
  DeviceView<double **> coords;    // (overlap nodes, Dim)   [m]    in
  DeviceView<LO **> cells;         // (cells, Nodes)                in
  DeviceView<double **> value;     // (points, Nodes)               in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)          in
  DeviceView<double *> weight;     // (points)                      in
  DeviceView<double *> u;          // (overlap dofs)         [m]    in
  double lambda, mu;               // Lame constants         [Pa]   in
  LO num_owned;
  DeviceView<double **> sum;   // (owned nodes, Voigt)          inout
  DeviceView<double *> volume; // (owned nodes)                 inout

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    const CellCoords<Dim, Nodes> x(coords, cells, cell);
    for (int q = 0; q < static_cast<int>(weight.extent(0)); ++q) {
      double dN[Nodes][Dim];
      const double part = weight(q) * physical_gradients(x, gradient, q, dN);
      double grad[Dim][Dim];
      displacement_gradient(u, cells, cell, dN, grad);
      double trace = 0;
      for (int i = 0; i < Dim; ++i) trace += grad[i][i];
      for (int a = 0; a < Nodes; ++a) {
        const LO node = cells(cell, a);
        if (node >= num_owned) continue;
        const double share = part * value(q, a);
        add_shared(volume(node), share);
        for (int k = 0; k < Voigt<Dim>::size; ++k) {
          const int i = Voigt<Dim>::row(k), j = Voigt<Dim>::col(k);
          const double stress = mu * (grad[i][j] + grad[j][i]) + (i == j ? lambda * trace : 0);
          add_shared(sum(node, k), share * stress);
        }
      }
    }
  }
};

} // namespace

std::vector<std::string> stress_names(const int dim)
{
  if (dim == 2) return {"stress_xx", "stress_yy", "stress_xy", "von_mises"};
  return {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz", "von_mises"};
}

RCP<MultiVector> nodal_stresses(const Discretization &d, const Material &material, const Vector &u)
{
  const mesh::Mesh &mesh = *d.mesh;
  const LO num_owned = mesh.num_owned_nodes();
  Vector u_overlap(d.overlap_dofs);
  u_overlap.doImport(u, *d.dof_import, Tpetra::INSERT);
  DeviceView<double *> u_local("rpc::fem::u_local", num_local(*d.overlap_dofs));
  Kokkos::deep_copy(u_local, device_read(u_overlap));
  const int components = d.dim() == 2 ? 3 : 6;
  DeviceView<double **> sum("rpc::fem::stress_sum", num_owned, components);
  DeviceView<double *> volume("rpc::fem::node_volume", num_owned);
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const BasisTable &table = d.reference.cell;
    const ProjectStress<dim, nodes> kernel{mesh.coords, mesh.cells,        table.value,   table.gradient, table.weight,
                                           u_local,     material.lambda(), material.mu(), num_owned,      sum,
                                           volume};
    Kokkos::parallel_for("rpc::fem::project_stress", device_range(mesh.num_cells()), kernel);
  });

  const auto result = rcp(new MultiVector(mesh.owned_nodes, components + 1));
  const auto stress = result->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const double nu = material.poissons_ratio;
  const bool plane = d.dim() == 2;
  Kokkos::parallel_for(
      "rpc::fem::nodal_stress", device_range(num_owned), KOKKOS_LAMBDA(const LO n) {
        double s[6];
        for (int k = 0; k < components; ++k) stress(n, k) = s[k] = sum(n, k) / volume(n);
        const double xx = s[0], yy = s[1], zz = plane ? nu * (xx + yy) : s[2];
        const double shear = plane ? s[2] * s[2] : s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
        const double spread = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
        stress(n, components) = Kokkos::Experimental::sqrt(0.5 * spread + 3 * shear);
      });
  Kokkos::fence();
  return result;
}

} // namespace rpc::fem
