#include "../full_disk.h"
#include "../test_files.h"

#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>

using namespace pcl_surflet;
namespace fs = std::filesystem;

namespace {

class DatabaseFile : public test::FileTest {
protected:
  void
  SetUp() override
  {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // PCL's own words are not the point
    HistogramModelTrainer trainer;
    trainer.setResolution({3, 4, 5, 2});
    database_.add(trainer.train("ball", sampleShape(Shape::sphere(0.1), 400, 1)));
    auto cup = trainer.train("cup \xC3\xA9", sampleShape(*shapeByName("cup"), 400, 1));
    cup.members.push_back(cup.members[0]);
    cup.members[1].condition = "noise 1 %";
    cup.members[1].area = 0.0123;
    cup.leaf = 0.0125;
    cup.centre = {0.5, -1.25, 2, 0, 0, 0, -0.1};
    database_.add(cup);
    trainer.setRole(ModelRole::Background);
    database_.add(trainer.train("table", sampleShape(Shape::plane(1, 1), 400, 1)));
    database_.setPenalty({0.5, 2e-5});
  }

  std::string
  loadError(const std::string& path)
  {
    try {
      loadDatabase(path);
    }
    catch (const DatabaseFileError& e) {
      return e.what();
    }
    return "no error";
  }

  /** \brief Error after \p damage was done to the table of a good file. */
  std::string
  errorAfter(const std::function<void(pcl::PCLPointCloud2&)>& damage)
  {
    saveDatabase(database_, path_);
    pcl::PCLPointCloud2 table;
    EXPECT_EQ(pcl::PCDReader().read(path_, table), 0);
    damage(table);
    pcl::PCDWriter().writeBinary(path_, table);
    return loadError(path_);
  }

  /** \brief Error after the value of \p field in entry \p row was overwritten. */
  template <class T>
  std::string
  errorWith(const std::string& field, T value, std::size_t row = 1, std::size_t element = 0)
  {
    return errorAfter([&](pcl::PCLPointCloud2& table) {
      for (const auto& f : table.fields)
        if (f.name == field)
          std::memcpy(table.data.data() + row * table.point_step + f.offset + element * sizeof(T),
                      &value, sizeof(T));
    });
  }

  std::string
  content()
  {
    return test::readFile(path_);
  }
  void
  write(const std::string& text)
  {
    test::writeFile(path_, text);
  }

  const std::string path_ = path("db.pcd");
  ModelDatabase database_;
};

void
expectHas(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

} // namespace

TEST_F(DatabaseFile, RoundTripKeepsEverything)
{
  saveDatabase(database_, path_);
  const auto loaded = loadDatabase(path_);
  ASSERT_EQ(loaded.size(), database_.size());
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    const auto &a = loaded[i], &b = database_[i];
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.role, b.role);
    EXPECT_EQ(a.resolution, b.resolution);
    EXPECT_EQ(a.delta_max, b.delta_max);
    EXPECT_EQ(a.r_mean, b.r_mean);
    EXPECT_EQ(a.r_max, b.r_max);
    EXPECT_EQ(a.r_min, b.r_min);
    EXPECT_EQ(a.surface_area, b.surface_area);
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.leaf, b.leaf);
    ASSERT_EQ(a.members.size(), b.members.size());
    for (std::size_t k = 0; k < a.members.size(); ++k) {
      EXPECT_EQ(a.members[k].condition, b.members[k].condition);
      EXPECT_EQ(a.members[k].features, b.members[k].features);
      EXPECT_EQ(a.members[k].area, b.members[k].area);
      EXPECT_EQ(a.members[k].histogram, b.members[k].histogram);
    }
  }
  EXPECT_EQ(loaded.getPenalty().tau, 0.5);
  EXPECT_EQ(loaded.getPenalty().floor, 2e-5);
}

TEST_F(DatabaseFile, AsciiAndCompressedCopiesLoadToo)
{
  saveDatabase(database_, path_);
  pcl::PCLPointCloud2 table;
  ASSERT_EQ(pcl::PCDReader().read(path_, table), 0);
  pcl::PCDWriter().writeBinaryCompressed(path_, table);
  EXPECT_EQ(loadDatabase(path_)[1].members[1].histogram, database_[1].members[1].histogram);
  pcl::PCDWriter().writeASCII(path_, table, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(),
                              9);
  EXPECT_EQ(loadDatabase(path_)[0].label, "ball");
  EXPECT_EQ(loadDatabase(path_)[0].members[0].histogram, database_[0].members[0].histogram);
}

TEST_F(DatabaseFile, EveryDamagedFieldIsNamed)
{
  const double nan = std::nan("");
  expectHas(errorWith("format_version", std::uint32_t{2}), "format version 2");
  expectHas(errorWith("role", std::uint32_t{7}), "role");
  expectHas(errorWith("member", std::uint32_t{5}, 2), "member");
  expectHas(errorWith("resolution", std::uint32_t{4000000000u}), "resolution");
  expectHas(errorWith("resolution", std::uint32_t{7}, 0), "bins");
  for (const auto* field : {"delta_max", "r_mean", "r_max", "r_min", "surface_area"}) {
    expectHas(errorWith(field, nan, 0), std::string("entry 1: model 'ball': ") + field);
    expectHas(errorWith(field, -1.0, 0), std::string(field) + " is negative");
  }
  expectHas(errorWith("delta_max", 0.0, 0), "delta_max");
  expectHas(errorWith("r_max", 1e6, 0), "radii");
  expectHas(errorWith("features", nan), "features");
  expectHas(errorWith("features", -3.0), "features");
  expectHas(errorWith("misfit", nan), "misfit");
  expectHas(errorWith("misfit_limit", -1.0), "misfit");
  expectHas(errorWith("area", nan), "area");
  expectHas(errorWith("area", -1.0), "area");
  expectHas(errorWith("leaf", -1.0, 0), "leaf is negative");
  expectHas(errorWith("leaf", 0.5, 2), "member");
  expectHas(errorWith("centre", nan, 0, 6), "centre is not finite");
  expectHas(errorWith("centre", 7.0, 2, 1), "member");
  expectHas(errorWith("tau", 0.25), "tau or floor");
  expectHas(errorWith("histogram", std::nanf(""), 1, 3), "not finite");
  expectHas(errorWith("histogram", -0.5f, 1, 3), "entry 2: model");
  expectHas(errorWith("histogram", 0.5f, 1, 3), "sum");
  expectHas(errorWith("label", char{0}, 0), "label");
  expectHas(errorWith("label", char{7}, 0), "control");
  expectHas(errorAfter([](auto& t) { std::memset(t.data.data() + t.fields[1].offset, 'x', 64); }),
            "end");
  // The file and the remedy are named too.
  expectHas(errorWith("r_max", 1e6, 0), path_);
  expectHas(errorWith("r_max", 1e6, 0), "train it again");
}

TEST_F(DatabaseFile, PenaltyIsChecked)
{
  expectHas(errorAfter([&](auto& t) {
              for (std::size_t row = 0; row < t.width; ++row)
                for (const auto& f : t.fields)
                  if (f.name == "tau")
                    std::memset(t.data.data() + row * t.point_step + f.offset, 0, 8);
            }),
            "tau");
}

TEST_F(DatabaseFile, MissingOrForeignFieldsAreRefused)
{
  const auto newer = [](const std::string& name) {
    return name.rfind("misfit", 0) == 0 || name == "centre" || name == "area" || name == "leaf";
  };
  for (int k = 0; k < 19; ++k) {
    std::string name;
    const auto error = errorAfter([&](auto& t) {
      name = t.fields[static_cast<std::size_t>(k)].name;
      t.fields[static_cast<std::size_t>(k)].name = "other";
    });
    if (!newer(name))
      expectHas(error, "no field '" + name + "'");
    else
      EXPECT_EQ(error, "no error") << "files from before " << name << " load as well";
  }
  expectHas(errorAfter([](auto& t) { t.fields[3].datatype = pcl::PCLPointField::FLOAT32; }),
            "role");
}

TEST_F(DatabaseFile, TwoModelsOfOneLabelAreRefused)
{
  expectHas(errorAfter([](auto& t) {
              const auto& f = t.fields[1];
              std::memcpy(t.data.data() + 3 * t.point_step + f.offset, t.data.data() + f.offset,
                          64);
            }),
            "already");
}

TEST_F(DatabaseFile, EveryTruncationIsRefused)
{
  saveDatabase(database_, path_);
  const auto whole = content();
  for (std::size_t n = 0; n < whole.size(); n += std::max<std::size_t>(1, whole.size() / 97)) {
    write(whole.substr(0, n));
    EXPECT_NE(loadError(path_), "no error") << n;
  }
}

TEST_F(DatabaseFile, HostileHeadersDoNotAllocate)
{
  saveDatabase(database_, path_);
  const auto whole = content();
  const auto with = [&](const std::string& entry, const std::string& value) {
    auto text = whole;
    const auto at = text.find(entry);
    text.replace(at, text.find('\n', at) - at, entry + " " + value);
    write(text);
    return loadError(path_);
  };
  expectHas(with("POINTS", "4000000000"), "points");
  expectHas(with("WIDTH", "99999999999999999999"), "WIDTH");
  expectHas(with("WIDTH", "-4"), "WIDTH");
  expectHas(with("COUNT", "1 64 64 1 1 4 1 1 1 1 1 1 1 1 4000000000"), "count");
  expectHas(with("COUNT", "1 64"), "fields");
  expectHas(with("DATA", "telepathy"), "telepathy");
  expectHas(with("FIELDS", ""), "fields");
}

TEST_F(DatabaseFile, WhatIsNoDatabaseIsRefused)
{
  expectHas(loadError((directory_ / "absent.pcd").string()), "does not exist");
  expectHas(loadError(directory_.string()), "directory");
  write("");
  expectHas(loadError(path_), "empty");
  write("OFF\n8 12 0\n");
  expectHas(loadError(path_), "PCD");
  write(std::string(100000, '\0'));
  expectHas(loadError(path_), "PCD");
  pcl::PointCloud<pcl::PointXYZ> cloud(3, 1);
  pcl::io::savePCDFileBinary(path_, cloud);
  expectHas(loadError(path_), "no field 'format_version'");
}

TEST_F(DatabaseFile, WritingIsAtomicAndFailuresAreTold)
{
  saveDatabase(database_, path_);
  const auto before = content();
  EXPECT_THROW(saveDatabase(ModelDatabase{}, path_), DatabaseFileError);
  EXPECT_EQ(content(), before);
  EXPECT_THROW(saveDatabase(database_, (directory_ / "no" / "db.pcd").string()), DatabaseFileError);
  EXPECT_THROW(saveDatabase(database_, directory_.string()), DatabaseFileError);
  {
    const test::FullDisk full(content().size() / 2);
    EXPECT_THROW(saveDatabase(database_, path_), DatabaseFileError);
  }
  EXPECT_EQ(content(), before);
  // Nothing but the database is left behind.
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(DatabaseFile, SameDatabaseSameBytes)
{
  saveDatabase(database_, path_);
  const auto once = content();
  saveDatabase(loadDatabase(path_), path_);
  EXPECT_EQ(content(), once);
}
