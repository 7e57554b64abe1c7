#include <Kokkos_Core.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <iostream>
#include <sstream>

namespace
{

/// Says on ranks > 0 only what failed; rank 0 has GoogleTest's own printer.
class FailurePrinter : public testing::EmptyTestEventListener
{
public:
  explicit FailurePrinter(const int rank) : rank_(rank) {}

private:
  void OnTestStart(const testing::TestInfo &test) override { test_ = &test; }
  void OnTestEnd(const testing::TestInfo &) override { test_ = nullptr; }
  void OnTestPartResult(const testing::TestPartResult &result) override
  {
    if (!result.failed()) return;
    std::ostringstream text; // one write, or the lines of several ranks mix
    text << "rank " << rank_ << ": ";
    if (test_) text << test_->test_suite_name() << '.' << test_->name() << ": ";
    text << (result.file_name() ? result.file_name() : "?") << ':' << result.line_number() << ": " << result.message()
         << '\n';
    std::cerr << text.str() << std::flush;
  }

  int rank_;
  const testing::TestInfo *test_ = nullptr;
};

/// Runs all tests on every rank; the exit code is 1 on every rank if a test failed on any.
int run_on_all(const Teuchos::Comm<int> &comm)
{
  const int rank = comm.getRank();
  auto &unit_test = *testing::UnitTest::GetInstance();
  if (rank > 0) {
    auto &listeners = unit_test.listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter(rank)); // owned by GoogleTest
  } else {
    std::cout << "[   RANKS  ] " << comm.getSize() << ", Kokkos " << Kokkos::DefaultExecutionSpace::name() << std::endl;
  }
  const bool failed_here = RUN_ALL_TESTS() != 0 || unit_test.total_test_count() == 0;
  const int mine = failed_here ? 1 : 0;
  int failed_ranks = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, mine, Teuchos::outArg(failed_ranks));
  if (rank == 0 && failed_ranks > 0)
    std::cout << "[  FAILED  ] on " << failed_ranks << " of " << comm.getSize() << " ranks" << std::endl;
  return failed_ranks > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv); // takes its options out of argv before Kokkos sees them
  const Tpetra::ScopeGuard scope(&argc, &argv);
  return run_on_all(*Tpetra::getDefaultComm());
}
