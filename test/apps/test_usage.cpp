// Command lines, right and wrong.
#include "app_runner.h"

#include "pcl_surflet/config.h"

using namespace pcl_surflet::test;

namespace {

const char* const kApps[] = {
    "train",          "classify",       "feature",         "info",      "reduce", "generate",
    "generate_shape", "evaluate",       "experiment",      "interpret", "view",   "search",
    "evaluate_pose",  "evaluate_peers", "evaluate_online", "replay"};

struct WrongLine {
  const char* app;
  std::vector<std::string> arguments;
  const char* named; ///< what the message must name
};

void
expectWrong(const std::vector<WrongLine>& lines)
{
  for (const auto& line : lines) {
    const AppRun r = run(line.app, line.arguments);
    EXPECT_TRUE(ended(r, 1, {line.named, "-h"})) << line.app << " " << line.named;
    EXPECT_EQ(r.out, "") << line.app << " " << line.named;
  }
}

/** \brief Words that the help of an app must have. */
const std::vector<std::pair<std::string, std::vector<std::string>>> kOptions = {
    {"train",
     {"-database", "-label", "-background", "-bins", "-bank", "-pairs", "-leaf", "-seed",
      "-threads", "-k"}},
    {"classify",
     {"-database", "-criterion", "-features", "-top", "-unknown", "-scale_normalized", "-seed",
      "-threads", "-k", "-csv"}},
    {"feature", {"-delta_max", "-pairs", "-seed", "-k"}},
    {"info", {"-csv"}},
    {"search",
     {"-database", "-classes", "-top", "-features", "-shortlist", "-exhaustive", "-seed",
      "-threads", "-k", "-csv"}},
    {"reduce", {"-leaf", "-min_normal", "-csv"}},
    {"replay",
     {"-database", "-background", "-empty", "-leaf", "-behind", "-out", "-csv", "-seed",
      "-threads"}},
    {"evaluate_online",
     {"-scenes", "-lengths", "-per_length", "-stride", "-leaf", "-stale", "-behind", "-batch_every",
      "-take", "-csv", "-seed", "-threads"}},
    {"evaluate", {"-method",   "-treatment", "-scenes",     "-bins",    "-leaf",        "-pairs",
                  "-lambda_h", "-lambda_o",  "-lambda_c",   "-min_fit", "-on_surfaces", "-present",
                  "-clutter",  "-unknown",   "-background", "-density", "-noise",       "-csv",
                  "-verbose",  "-seed",      "-threads",    "-row",     "-peers",       "-memory",
                  "-critical", "-scaling",   "-times",      "-extra",   "classic_vfh"}},
    {"interpret",
     {"-database", "-method", "-background", "-empty", "-planes", "-distance", "-leaf", "-max",
      "-out", "-objects_dir", "-picture", "-csv", "-verbose", "-k", "-seed", "-threads", "-pose",
      "-viewpoints"}},
    {"view",
     {"-database", "-picture", "-width", "-height", "-azimuth", "-elevation", "-zoom", "-point",
      "-overlay"}},
    {"generate",
     {"-out", "-poses", "-empty", "-models", "-present", "-clutter", "-unknown", "-background",
      "-size", "-wall", "-posture", "-spacing", "-factor", "-gap", "-density", "-noise", "-seed"}},
    {"generate_shape", {"-points", "-noise", "-seed", "wine_glass"}}};

} // namespace

TEST(Usage, HelpGoesToStdoutAndSucceeds)
{
  for (const auto* app : kApps)
    for (const auto* flag : {"-h", "--help"}) {
      const AppRun r = run(app, {flag});
      EXPECT_EQ(r.code, 0) << app;
      EXPECT_EQ(r.err, "") << app;
      for (const std::string& word : {std::string("Usage: pcl_surflet_") + app,
                                      std::string("Exit codes: 0"), std::string("-h, --help")})
        EXPECT_NE(r.out.find(word), std::string::npos) << app << ": " << word;
    }
  EXPECT_EQ(run("train", {"-nonsense", "-h"}).code, 0) << "asking for help is never wrong";
}

TEST(Usage, VersionIsThatOfTheProject)
{
  for (const std::string app : kApps)
    for (const auto* flag : {"-version", "--version"}) {
      const AppRun r = run(app, {flag, "-nonsense"});
      EXPECT_EQ(r.code, 0) << app;
      EXPECT_EQ(r.err, "") << app;
      EXPECT_EQ(r.out, "pcl_surflet_" + app + " (pcl_surflet) " PCL_SURFLET_VERSION "\n");
    }
  EXPECT_EQ(run("train", {"-database", "d.pcd", "--", "-version"}).code, 2) << "this is a file";
}

TEST(Usage, HelpNamesEveryOption)
{
  for (const auto& [app, names] : kOptions) {
    const std::string help = run(app, {"-h"}).out;
    for (const auto& name : names)
      EXPECT_NE(help.find(name), std::string::npos) << app << " " << name;
  }
}

TEST(Usage, UnknownOptionsAndMissingArgumentsAreNamed)
{
  for (const auto* app : kApps)
    expectWrong({{app, {"-colour", "red"}, "-colour"}, {app, {"--threads"}, "--threads"}});
  expectWrong(
      {{"train", {"a.pcd"}, "-database"},
       {"train", {"-database", "d.pcd"}, "FILE"},
       {"train", {}, "-database"},
       {"train", {"-database", "d.pcd", "-leaf", "0.1", "-bank", "default", "a.off"}, "-bank"},
       {"train", {"-database", "d.pcd", "-leaf", "0.1", "-pairs", "1000", "a.off"}, "-pairs"},
       {"train", {"-database", "d.pcd", "-leaf", "0.1", "-background", "a.off"}, "-background"},
       {"train", {"-database", "d.pcd", "-views", "a.off"}, "-leaf"},
       {"classify", {"a.pcd"}, "-database"},
       {"classify", {"-database", "d.pcd"}, "FILE"},
       {"feature", {"a.pcd"}, "OUT.pcd"},
       {"feature", {"a.pcd", "b.pcd", "c.pcd"}, "c.pcd"},
       {"info", {}, "DB.pcd"},
       {"info", {"a.pcd", "b.pcd"}, "b.pcd"},
       {"evaluate", {"-csv"}, "ITEM"},
       {"evaluate_pose", {"-views", "one", "-noise", "0.1", "cup"}, "-noise"},
       {"evaluate_peers", {"-views", "one", "-noise", "0.1", "cup"}, "-noise"},
       {"interpret", {"s.pcd"}, "-database"},
       {"interpret", {"-database", "d.pcd"}, "SCENE"},
       {"interpret", {"-database", "d.pcd", "-out", "o.pcd", "a.pcd", "b.pcd"}, "b.pcd"},
       {"interpret", {"-database", "d.pcd", "-background", "exclude", "s.pcd"}, "-empty"},
       {"interpret", {"-database", "d.pcd", "-planes", "1", "s.pcd"}, "-planes"},
       {"interpret", {"-database", "d.pcd", "-picture", "p.png", "a.pcd", "b.pcd"}, "b.pcd"},
       {"view", {}, "LABELLED"},
       {"generate", {"cup"}, "-out"},
       {"generate", {"-out", "s.pcd"}, "ITEM"},
       {"generate_shape", {"sphere"}, "OUT"},
       {"generate_shape", {"sphere", "a.pcd", "b"}, "'b'"}});
}

TEST(Usage, MissingAndRepeatedValuesAreNamed)
{
  expectWrong({{"train", {"a.pcd", "-database"}, "-database"},
               {"train", {"-database", "-label", "x", "a.pcd"}, "-database"},
               {"train", {"-database", "", "a.pcd"}, "-database"},
               {"train", {"-database", "d.pcd", "-seed", "1", "-seed", "2", "a.pcd"}, "-seed"},
               {"classify", {"-database", "d.pcd", "a.pcd", "-top"}, "-top"},
               {"classify", {"-database", "d.pcd", "a.pcd", "-unknown", "--"}, "-unknown"},
               {"feature", {"a.pcd", "b.pcd", "-delta_max"}, "-delta_max"},
               {"generate_shape", {"sphere", "a.pcd", "-noise"}, "-noise"}});
}

TEST(Usage, MalformedNumbersAreNamed)
{
  for (const std::string bad :
       {"abc", "1x", "", " 1", "1.5", "-1", "0x10", "99999999999999999999", "nan", "+1"}) {
    expectWrong({{"train", {"-database", "d.pcd", "a.pcd", "-seed", bad}, "-seed"},
                 {"train", {"-database", "d.pcd", "a.pcd", "-threads", bad}, "-threads"},
                 {"train", {"-database", "d.pcd", "a.pcd", "-pairs", bad}, "-pairs"},
                 {"train", {"-database", "d.pcd", "a.pcd", "-k", bad}, "-k"},
                 {"classify", {"-database", "d.pcd", "a.pcd", "-features", bad}, "-features"},
                 {"classify", {"-database", "d.pcd", "a.pcd", "-top", bad}, "-top"},
                 {"generate_shape", {"sphere", "a.pcd", "-points", bad}, "-points"}});
  }
  for (const std::string bad : {"abc", "1x", "", " 1", "nan", "inf", "1e999", "1,5"})
    expectWrong({{"classify", {"-database", "d.pcd", "a.pcd", "-unknown", bad}, "-unknown"},
                 {"feature", {"a.pcd", "b.pcd", "-delta_max", bad}, "-delta_max"},
                 {"generate_shape", {"sphere", "a.pcd", "-noise", bad}, "-noise"}});
}

TEST(Usage, ValuesOutOfRangeAreNamed)
{
  expectWrong({{"train", {"-database", "d.pcd", "a.pcd", "-pairs", "0"}, "-pairs"},
               {"train", {"-database", "d.pcd", "a.pcd", "-k", "2"}, "-k"},
               {"train", {"-database", "d.pcd", "a.pcd", "-threads", "100000"}, "-threads"},
               {"classify", {"-database", "d.pcd", "a.pcd", "-top", "0"}, "-top"},
               {"classify", {"-database", "d.pcd", "a.pcd", "-features", "0"}, "-features"},
               {"feature", {"a.pcd", "b.pcd", "-delta_max", "0"}, "-delta_max"},
               {"feature", {"a.pcd", "b.pcd", "-delta_max", "-1"}, "-delta_max"},
               {"generate_shape", {"sphere", "a.pcd", "-points", "2"}, "-points"},
               {"generate_shape", {"sphere", "a.pcd", "-noise", "-0.1"}, "-noise"}});
}

TEST(Usage, WrongNamesAreNamed)
{
  expectWrong(
      {{"classify", {"-database", "d.pcd", "a.pcd", "-criterion", "best"}, "likelihood"},
       {"evaluate", {"-method", "guess", "cup"}, "explanation"},
       {"evaluate", {"-method", "dissertation,", "cup"}, "classic_esf"},
       {"evaluate", {"-treatment", "pray", "cup"}, "exclude"},
       {"evaluate", {"-scaling", "time", "cup"}, "models"},
       {"evaluate", {"-scaling", "models", "-times", "2", "cup"}, "-extra"},
       {"evaluate", {"-times", "1,,2", "cup"}, "-times"},
       {"evaluate", {"-critical", "-1", "cup"}, "-critical"},
       {"evaluate", {"-present", "2", "cup"}, "-present"},
       {"generate", {"-out", "s.pcd", "-background", "sea", "cup"}, "bowl"},
       {"generate", {"-out", "s.pcd", "-posture", "proud", "cup"}, "leaning"},
       {"generate", {"-out", "s.pcd", "cup:2"}, "'cup'"},
       {"generate", {"-out", "s.pcd", "a.off:2:w"}, "a.off:2:w"},
       {"generate", {"-out", "s.pcd", "a.off:two"}, "DIAMETER"},
       {"generate", {"-out", "s.pcd", "-present", "2", "cup"}, "-present"},
       {"generate", {"-out", "s.pcd", "-unknown", "1", "cup"}, "-unknown"},
       {"generate", {"-out", "s.pcd", "-pixels", "320x240", "cup"}, "-views"},
       {"generate", {"-out", "s.txt", "cup"}, ".pcd"},
       {"evaluate", {"-grazing", "80", "cup"}, "-views"},
       {"evaluate_online", {"-path", "9", "cup"}, "-path"},
       {"search", {"-database", "d.pcd", "-exhaustive", "-shortlist", "3", "a.pcd"}, "-exhaustive"},
       {"view", {"-picture", "x.jpg", "s.pcd"}, ".png"},
       {"feature", {"a.pcd", "b.txt"}, ".pcd"},
       {"reduce", {"-leaf", "1", "a.pcd", "b.ply"}, ".pcd"},
       {"replay", {"-database", "d.pcd", "-out", "x.ply", "a.pcd"}, ".pcd"},
       {"train", {"-database", "d.pcd", "unknown.pcd"}, "-label"},
       {"generate_shape", {"dodecahedron", "a.pcd"}, "wine_glass"},
       {"generate_shape", {"sphere", "a.stl"}, ".off"}});
}

TEST(Usage, WrongResolutionsAreNamed)
{
  for (const std::string bad : {"5", "5,5,5", "5,5,5,5,5", "5,5,5,", ",5,5,5", "5,5,5,0",
                                "5,5,5,65", "64,64,64,64", "a,b,c,d", "5 5 5 5", "5,5,5,-5"})
    expectWrong({{"train", {"-database", "d.pcd", "a.pcd", "-bins", bad}, "-bins"}});
}

TEST(Usage, OneLabelForOneFile)
{
  expectWrong({{"train", {"-database", "d.pcd", "-label", "x", "a.pcd", "b.pcd"}, "-label"},
               {"train", {"-database", "d.pcd", "-label", std::string(64, 'x'), "a.pcd"}, "-label"},
               {"train", {"-database", "d.pcd", "one/a.pcd", "two/a.off"}, "one/a.pcd"}});
}
