#include "app_runner.h"

#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pcl_surflet {
namespace test {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kSeconds = 60;
// Sanitisers reserve terabytes of address space for themselves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif
constexpr rlim_t kMemory = rlim_t{3} << 30;

void
redirect(const std::string& path, int to)
{
  const int from = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(from, to);
  ::close(from);
}

[[noreturn]] void
execute(const std::vector<std::string>& command, const std::string& out, const std::string& err)
{
  redirect(out, STDOUT_FILENO);
  redirect(err, STDERR_FILENO);
  ::alarm(kSeconds);
  const rlimit memory{kMemory, kMemory};
  if (kLimitMemory)
    ::setrlimit(RLIMIT_AS, &memory);
  std::vector<char*> argv;
  for (const auto& argument : command)
    argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

} // namespace

std::string
appPath(const std::string& app)
{
  return std::string(PCL_SURFLET_APP_DIRECTORY) + "/pcl_surflet_" + app;
}

Running::Running(const std::vector<std::string>& command, const std::string& out)
{
  const std::string name =
      (fs::temp_directory_path() / ("surflet_run_" + std::to_string(::getpid()))).string();
  keep_out_ = !out.empty();
  out_file_ = keep_out_ ? out : name + ".out";
  err_file_ = name + ".err";
  fs::remove(err_file_);
  pid_ = ::fork();
  if (pid_ == 0)
    execute(command, out_file_, err_file_);
}

std::string
Running::err() const
{
  return readFile(err_file_);
}

AppRun
Running::wait()
{
  int status = 0;
  ::waitpid(pid_, &status, 0);
  AppRun result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.err = readFile(err_file_);
  fs::remove(err_file_);
  if (!keep_out_) {
    result.out = readFile(out_file_);
    fs::remove(out_file_);
  }
  return result;
}

AppRun
run(const std::string& app, const std::vector<std::string>& arguments, const std::string& out)
{
  std::vector<std::string> command = {appPath(app)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return Running(command, out).wait();
}

std::vector<std::vector<std::string>>
parseCsv(const std::string& text)
{
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && quoted && i + 1 < text.size() && text[i + 1] == '"')
      row.back() += text[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      row.emplace_back();
    else if (c == '\n' && !quoted) {
      rows.push_back(row);
      row.assign(1, "");
    }
    else
      row.back() += c;
  }
  return rows;
}

testing::AssertionResult
ended(const AppRun& run, int code, const std::vector<std::string>& words)
{
  if (run.code != code)
    return testing::AssertionFailure()
           << "exit code " << run.code << " instead of " << code << ", stderr: " << run.err;
  for (const auto& word : words)
    if (run.err.find(word) == std::string::npos)
      return testing::AssertionFailure() << "no '" << word << "' in: " << run.err;
  return testing::AssertionSuccess();
}

void
Apps::makeShapes()
{
  ASSERT_EQ(run("generate_shape", {"sphere", path("ball.pcd"), "-points", "2000"}).code, 0);
  ASSERT_EQ(run("generate_shape", {"cube", path("die.ply"), "-points", "2000"}).code, 0);
  ASSERT_EQ(run("generate_shape", {"cup", path("cup.off"), "-points", "500"}).code, 0);
}

void
Apps::makeDatabase()
{
  makeShapes();
  const AppRun r = run("train", {"-database", path("db.pcd"), "-pairs", "200000", path("ball.pcd"),
                                 path("die.ply"), path("cup.off")});
  ASSERT_TRUE(ended(r, 0, {"added 'ball'", "added 'die'", "added 'cup'"}));
}

void
Apps::makeSceneDatabase(const std::vector<std::string>& shapes, const std::string& points)
{
  for (const auto& shape : shapes) {
    const std::string cloud = path(shape + ".pcd");
    ASSERT_EQ(run("generate_shape", {shape, cloud, "-points", points}).code, 0);
    ASSERT_EQ(
        run("train", {"-database", path("db.pcd"), "-bins", "7,7,7,7", "-pairs", "1000000", cloud})
            .code,
        0);
  }
}

} // namespace test
} // namespace pcl_surflet
