#pragma once

#include "rpc/contact/contact_nodes.hpp"

#include <limits>

namespace rpc::contact
{

/// The generalized Hessian of the smoothed functional, one stiffness at each contact node beside that of the body:
///
///     H = K + sum_i added_i w_i m_i m_i^T                                                         doc/theory.md (4.2)
///
/// with m_i the node's direction. One matrix holds K with what was added when it was last written, so that a
/// preconditioner made for it can go on while H changes. Products write into the nodes' own blocks, for as long as they take,
/// what they are to be: r w |u| less r w |u| would leave its rounding. All members are collective.
class ContactStiffness : public Operator
{
public:
  /// @param K  SPD, of the body alone; becomes the matrix
  ContactStiffness(RCP<CrsMatrix> K, const ContactNodes &contact);

  /// y <- alpha H x + beta y.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return matrix_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return matrix_->getRangeMap(); }
  bool hasTransposeApply() const override { return false; }

  /// Ku <- K u.
  void apply_elastic(const Vector &u, Vector &Ku) const;

  /// @param added  (contact nodes) [Pa/m], >= 0
  /// @return number of nodes where it changed, over all ranks
  GO set(const DeviceView<double *> &added);
  /// Brings the matrix to H, with at most `most` times a node's own stiffness added at each: time for a new preconditioner.
  void write(double most = std::numeric_limits<double>::infinity());
  const RCP<CrsMatrix> &matrix() const { return matrix_; }
  /// Grows with each change of H.
  int revision() const { return revision_; }

  /// Contact nodes whose part of H is not in the matrix: each adds coefficient m m^T to its node's own block. Of this rank.
  struct Changes {
    DeviceView<LO *> node;            ///< (n) owned node lids
    DeviceView<double **> direction;  ///< (n, dim) m
    DeviceView<double *> coefficient; ///< (n) (added - written) w [Pa m^(dim-2)], not 0
    LO size() const { return static_cast<LO>(node.extent(0)); }
  };
  Changes changes() const;
  int dim() const { return contact_.dim; }

  /// (contact nodes) m . K_ii m / (w m . m) of the node's own block [Pa/m]; 0 where the direction is.
  const DeviceView<double *> &own_stiffness() const { return own_stiffness_; }

  /// (contact nodes) kappa_i = sum_j |m_i . K_ij m_j| / |m_i|^2 over the contact nodes j, with |.| entry by entry, made at the
  /// first call, which is collective: the elastic energy of moves s_i m_i/|m_i|^2 of all contact nodes at once is at most sum_i kappa_i s_i^2/2. [N/m]
  const DeviceView<double *> &sweep_stiffness() const;

private:
  RCP<CrsMatrix> matrix_;
  ContactNodes contact_;
  mutable DeviceView<double *> sweep_stiffness_;
  mutable bool has_sweep_stiffness_ = false; // on all ranks, those without contact nodes too
  DeviceView<double *> added_, written_;     // (contact nodes) of H, and of the matrix [Pa/m]
  bool has_changes_ = false;                 // since the matrix was written
  DeviceView<double *> nothing_;             // (contact nodes) 0
  DeviceView<double *> own_stiffness_;
  DeviceView<std::size_t **> block_; // (contact nodes, dim) entry where the node's own block begins in each of its rows
  DeviceView<double ***> elastic_;   // (contact nodes, dim, dim) that block of K
  int revision_ = 0;
};

} // namespace rpc::contact
