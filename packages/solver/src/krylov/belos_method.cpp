// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/belos_method.hpp"

#include "krylov/krylov_vectors.hpp"
#include "rpc/solver/rules.hpp"

#include <BelosLinearProblem.hpp>
#include <BelosSolverFactory.hpp>
#include <BelosStatusTest.hpp>
#include <BelosTpetraAdapter.hpp>
#include <algorithm>
#include <cctype>
#include <vector>

namespace rpc::solver
{
namespace
{

std::string in_capitals(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Names of those methods of Belos that take the new vector's products with all others in each iteration.
bool is_gmres(const std::string &method)
{
  const std::string name = in_capitals(method);
  const auto is_any = [&name](const auto &...names) { return ((name == names) || ...); };
  return is_any("GMRES", "BLOCK GMRES", "FLEXIBLE GMRES", "PSEUDOBLOCK GMRES", "PSEUDO BLOCK GMRES",
                "PSEUDOBLOCKGMRES");
}

/// Tpetra's vectors and operators in Belos.
struct TpetraKind {
  using Vectors = MultiVector;
  using Op = rpc::Operator;
  static RCP<Vectors> vectors(const RCP<Vector> &x) { return x; }
  static RCP<const Op> op(const RCP<const rpc::Operator> &of) { return of; }
  static RCP<const Vector> vector(const Vectors &of) { return of.getVector(0); }
};

/// KrylovVectors.
struct KrylovKind {
  using Vectors = Belos::MultiVec<double>;
  using Op = Belos::Operator<double>;
  static RCP<Vectors> vectors(const RCP<Vector> &x)
  {
    return rcp(new KrylovVectors(x->getMap(), std::vector<RCP<Vector>>{x}));
  }
  static RCP<const Op> op(const RCP<const rpc::Operator> &of) { return rcp(new OnKrylovVectors(of)); }
  static RCP<const Vector> vector(const Vectors &of) { return dynamic_cast<const KrylovVectors &>(of).vector(0); }
};

/// Asks before each iteration of GMRES, which applies its preconditioner to no residual. It ends nothing but by an exception.
template <class Kind>
class Asking : public Belos::StatusTest<double, typename Kind::Vectors, typename Kind::Op>
{
public:
  using Iteration = Belos::Iteration<double, typename Kind::Vectors, typename Kind::Op>;
  explicit Asking(const std::function<void(int, double)> &ask) : ask_(ask) {}
  Belos::StatusType checkStatus(Iteration *const at) override
  {
    if (!ask_) return Belos::Undefined;
    std::vector<double> norm(1);
    at->getNativeResiduals(&norm); // GMRES' are numbers alone
    at_ = at;
    ask_(at->getNumIters(), norm[0]);
    return Belos::Undefined;
  }
  void add_update(Vector &x) const
  {
    const auto update = at_->getCurrentUpdate(); // null before the first iteration
    if (!update.is_null()) x.update(1., *Kind::vector(*update), 1.);
  }
  Belos::StatusType getStatus() const override { return Belos::Undefined; }
  void reset() override {}
  void print(std::ostream &, int) const override {}

private:
  const std::function<void(int, double)> &ask_;
  const Iteration *at_ = nullptr;
};

template <class Kind>
class MethodFor : public BelosMethod
{
public:
  using Problem = Belos::LinearProblem<double, typename Kind::Vectors, typename Kind::Op>;
  using Factory = Belos::SolverFactory<double, typename Kind::Vectors, typename Kind::Op>;

  MethodFor(const std::string &name, const RCP<Teuchos::ParameterList> &list, const RCP<const rpc::Operator> &H,
            const RCP<const rpc::Operator> &preconditioner)
      : problem_(rcp(new Problem(Kind::op(H), Teuchos::null, Teuchos::null)))
  {
    problem_->setRightPrec(Kind::op(preconditioner));
    manager_ = Factory().create(name, list);
    if (is_gmres(name)) {
      asking_ = rcp(new Asking<Kind>(before_iteration));
      manager_->setDebugStatusTest(asking_);
      // Others precondition their updates at the end.
      is_flexible_ = list->isParameter("Flexible Gmres") && list->get<bool>("Flexible Gmres");
    }
    manager_->setProblem(problem_);
  }
  bool solve(const double tolerance, const Vector &b, Vector &x) override
  {
    const auto list = Teuchos::parameterList();
    list->set("Convergence Tolerance", tolerance);
    manager_->setParameters(list);
    x.putScalar(0);
    const auto right_side = Kind::vectors(Teuchos::rcp_const_cast<Vector>(Teuchos::rcpFromRef(b)));
    // The residual of 0 needs no product. CG overwrites it.
    problem_->setInitResVec(Kind::vectors(rcp(new Vector(b, Teuchos::Copy))));
    problem_->setProblem(Kind::vectors(Teuchos::rcpFromRef(x)), right_side);
    return manager_->solve() == Belos::Converged;
  }
  int iterations() const override { return manager_->getNumIters(); }
  double achieved() const override { return manager_->achievedTol(); }
  bool tells_update() const override { return is_flexible_; }
  void add_update(Vector &x) const override
  {
    if (!asking_.is_null()) asking_->add_update(x);
  }

private:
  RCP<Problem> problem_;
  RCP<Belos::SolverManager<double, typename Kind::Vectors, typename Kind::Op>> manager_;
  RCP<Asking<Kind>> asking_; // null but of GMRES
  bool is_flexible_ = false;
};

} // namespace

bool needs_symmetry(const std::string &method)
{
  const std::string name = in_capitals(method);
  const auto has = [&name](const char *part) { return name.find(part) != std::string::npos; };
  return (has("CG") && !has("BICG")) || has("PCPG") || has("MINRES");
}

Teuchos::ParameterList gmres_defaults(const int max_iterations)
{
  Teuchos::ParameterList list;
  list.set("Num Blocks", std::min<int>(linear_rules.gmres_vectors, max_iterations));
  list.set("Maximum Restarts", max_iterations);
  list.set("Flexible Gmres", true);
  return list;
}

RCP<const Teuchos::ParameterList> belos_parameters(const std::string &method)
{
  return MethodFor<TpetraKind>::Factory().create(method, Teuchos::parameterList())->getValidParameters();
}

Teuchos::ParameterList entries_for(const std::string &method, const Teuchos::ParameterList &deck)
{
  const auto known = belos_parameters(method);
  Teuchos::ParameterList entries;
  for (auto it = deck.begin(); it != deck.end(); ++it)
    if (known->isParameter(it->first)) entries.setEntry(it->first, it->second);
  return entries;
}

std::unique_ptr<BelosMethod> belos_method(const std::string &name, const RCP<Teuchos::ParameterList> &list,
                                          const RCP<const rpc::Operator> &H,
                                          const RCP<const rpc::Operator> &preconditioner)
{
  if (is_gmres(name)) return std::make_unique<MethodFor<KrylovKind>>(name, list, H, preconditioner);
  return std::make_unique<MethodFor<TpetraKind>>(name, list, H, preconditioner);
}

} // namespace rpc::solver
