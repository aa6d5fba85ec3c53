#include "pcl_surflet/database_file.h"

#include "core/atomic_file.h"
#include "pcl_adapters/pcd_content.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pcl_surflet {
namespace {

using pcl::PCLPointField;

constexpr std::uint32_t kFormatVersion = 1;
constexpr std::uint32_t kTextBytes = HistogramModel::kMaxLabelBytes + 1;

constexpr std::uint32_t kCentreTerms = std::tuple_size<CentreWeights>::value;

struct FieldSpec {
  const char* name;
  std::uint8_t type;
  std::uint32_t count; ///< 0: number of bins
  bool optional = false;
};

const std::array<FieldSpec, 20> kFields = {{{"format_version", PCLPointField::UINT32, 1},
                                            {"label", PCLPointField::UINT8, kTextBytes},
                                            {"condition", PCLPointField::UINT8, kTextBytes},
                                            {"role", PCLPointField::UINT32, 1},
                                            {"member", PCLPointField::UINT32, 1},
                                            {"resolution", PCLPointField::UINT32, 4},
                                            {"delta_max", PCLPointField::FLOAT64, 1},
                                            {"r_mean", PCLPointField::FLOAT64, 1},
                                            {"r_max", PCLPointField::FLOAT64, 1},
                                            {"r_min", PCLPointField::FLOAT64, 1},
                                            {"surface_area", PCLPointField::FLOAT64, 1},
                                            {"features", PCLPointField::FLOAT64, 1},
                                            {"tau", PCLPointField::FLOAT64, 1},
                                            {"floor", PCLPointField::FLOAT64, 1},
                                            {"misfit", PCLPointField::FLOAT64, 1, true},
                                            {"misfit_limit", PCLPointField::FLOAT64, 1, true},
                                            {"area", PCLPointField::FLOAT64, 1, true},
                                            {"leaf", PCLPointField::FLOAT64, 1, true},
                                            {"centre", PCLPointField::FLOAT64, kCentreTerms, true},
                                            {"histogram", PCLPointField::FLOAT32, 0}}};

/** \brief One row of the table: a member of a model. */
struct Row {
  std::uint32_t format_version = kFormatVersion, role = 0, member = 0;
  std::array<char, kTextBytes> label{}, condition{};
  std::array<std::uint32_t, 4> resolution{};
  double delta_max = 0, r_mean = 0, r_max = 0, r_min = 0, surface_area = 0, features = 0, tau = 0,
         floor = 0, misfit = 0, misfit_limit = 0, area = 0, leaf = 0;
  CentreWeights centre{};
  std::vector<float> histogram;

  /** \brief Where each field of kFields lives, in that order. */
  std::array<void*, kFields.size()>
  places()
  {
    return {&format_version,
            label.data(),
            condition.data(),
            &role,
            &member,
            resolution.data(),
            &delta_max,
            &r_mean,
            &r_max,
            &r_min,
            &surface_area,
            &features,
            &tau,
            &floor,
            &misfit,
            &misfit_limit,
            &area,
            &leaf,
            centre.data(),
            histogram.data()};
  }
};

pcl::PCLPointCloud2
emptyTable(std::uint32_t bins)
{
  pcl::PCLPointCloud2 table;
  for (const auto& spec : kFields) {
    PCLPointField field;
    field.name = spec.name;
    field.offset = table.point_step;
    field.datatype = spec.type;
    field.count = spec.count > 0 ? spec.count : bins;
    table.point_step += field.count * static_cast<std::uint32_t>(pcl::getFieldSize(field.datatype));
    table.fields.push_back(field);
  }
  table.height = 1;
  table.is_dense = true;
  return table;
}

void
setText(std::array<char, kTextBytes>& to, const std::string& from)
{
  std::copy(from.begin(), from.end(), to.begin());
}

Row
rowOf(const HistogramModel& model, std::size_t member, const PenaltyParameters& penalty)
{
  Row row;
  row.role = model.role == ModelRole::Background ? 1 : 0;
  row.member = static_cast<std::uint32_t>(member);
  setText(row.label, model.label);
  setText(row.condition, model.members[member].condition);
  const auto& r = model.resolution;
  row.resolution = {static_cast<std::uint32_t>(r.alpha), static_cast<std::uint32_t>(r.beta),
                    static_cast<std::uint32_t>(r.gamma), static_cast<std::uint32_t>(r.delta)};
  row.delta_max = model.delta_max;
  row.r_mean = model.r_mean;
  row.r_max = model.r_max;
  row.r_min = model.r_min;
  row.surface_area = model.surface_area;
  row.leaf = model.leaf;
  row.features = static_cast<double>(model.members[member].features);
  row.tau = penalty.tau;
  row.floor = penalty.floor;
  row.misfit = model.members[member].misfit;
  row.misfit_limit = model.members[member].misfit_limit;
  row.area = model.members[member].area;
  row.centre = model.centre;
  row.histogram = model.members[member].histogram;
  return row;
}

void
appendRow(Row& row, pcl::PCLPointCloud2& table)
{
  const auto places = row.places();
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const auto* begin = static_cast<const std::uint8_t*>(places[f]);
    const auto bytes = table.fields[f].count *
                       static_cast<std::uint32_t>(pcl::getFieldSize(table.fields[f].datatype));
    table.data.insert(table.data.end(), begin, begin + bytes);
  }
  ++table.width;
}

/** \brief Reads rows and says of which file and which model it speaks when it refuses. */
class TableReader {
public:
  TableReader(const std::string& path, const pcl::PCLPointCloud2& table)
      : path_(path), table_(table)
  {
    for (std::size_t f = 0; f < kFields.size(); ++f)
      field_[f] = find(kFields[f]);
    bins_ = field_.back()->count;
  }

  [[noreturn]] void
  refuse(const std::string& why) const
  {
    throw DatabaseFileError("cannot use the database '" + path_ + "': " + why);
  }

  Row
  row(std::size_t index) const
  {
    Row row;
    row.histogram.resize(bins_);
    const auto places = row.places();
    const auto* begin = table_.data.data() + index * table_.point_step;
    for (std::size_t f = 0; f < field_.size(); ++f)
      if (field_[f] != nullptr)
        std::memcpy(places[f], begin + field_[f]->offset,
                    field_[f]->count *
                        static_cast<std::size_t>(pcl::getFieldSize(field_[f]->datatype)));
    return row;
  }

private:
  /** \brief The field, or null if it may be missing: files from before it was invented. */
  const PCLPointField*
  find(const FieldSpec& spec) const
  {
    for (const auto& field : table_.fields) {
      if (field.name != spec.name)
        continue;
      if (field.datatype != spec.type || (spec.count > 0 && field.count != spec.count))
        refuse("its field '" + field.name +
               "' has another type or count than format version 1 has; was it written by "
               "pcl_surflet?");
      return &field;
    }
    if (spec.optional)
      return nullptr;
    refuse(std::string("it has no field '") + spec.name +
           "'; is it a database made by pcl_surflet_train?");
  }

  const std::string& path_;
  const pcl::PCLPointCloud2& table_;
  std::array<const PCLPointField*, kFields.size()> field_{};
  std::size_t bins_ = 0;
};

std::string
textOf(const std::array<char, kTextBytes>& text, const TableReader& reader,
       const std::string& where)
{
  const auto end = std::find(text.begin(), text.end(), '\0');
  if (end == text.end())
    reader.refuse(where + ": a text does not end");
  return {text.begin(), end};
}

HistogramModel
modelOf(const Row& row, const TableReader& reader, const std::string& where)
{
  HistogramModel model;
  if (row.format_version != kFormatVersion)
    reader.refuse(where + ": format version " + std::to_string(row.format_version) +
                  " instead of 1; it was made by a newer pcl_surflet, or it is damaged");
  if (row.role > 1)
    reader.refuse(where + ": the role is neither object (0) nor background (1)");
  if (!(row.features >= 0) || row.features > 0x1p53)
    reader.refuse(where + ": the number of features is impossible");
  for (const auto n : row.resolution)
    if (n > static_cast<std::uint32_t>(Resolution::kMaxPerDimension))
      reader.refuse(where + ": the resolution is impossible");
  model.label = textOf(row.label, reader, where);
  model.role = row.role == 1 ? ModelRole::Background : ModelRole::Object;
  model.resolution = {static_cast<int>(row.resolution[0]), static_cast<int>(row.resolution[1]),
                      static_cast<int>(row.resolution[2]), static_cast<int>(row.resolution[3])};
  model.delta_max = row.delta_max;
  model.r_mean = row.r_mean;
  model.r_max = row.r_max;
  model.r_min = row.r_min;
  model.surface_area = row.surface_area;
  model.centre = row.centre;
  model.leaf = row.leaf;
  model.members.push_back({textOf(row.condition, reader, where), row.histogram,
                           static_cast<std::uint64_t>(row.features), row.misfit, row.misfit_limit,
                           row.area});
  if (const auto problem = model.problem(); !problem.empty())
    reader.refuse(where + ": " + problem + "; train it again");
  return model;
}

/** \brief Do two rows describe members of one model? */
bool
sameModel(const HistogramModel& a, const HistogramModel& b)
{
  return a.label == b.label && a.role == b.role && a.resolution == b.resolution &&
         a.delta_max == b.delta_max && a.r_mean == b.r_mean && a.r_max == b.r_max &&
         a.r_min == b.r_min && a.surface_area == b.surface_area && a.centre == b.centre &&
         a.leaf == b.leaf;
}

std::vector<HistogramModel>
modelsOf(const TableReader& reader, std::size_t rows, PenaltyParameters& penalty)
{
  std::vector<HistogramModel> models;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string where = "entry " + std::to_string(i + 1);
    const Row row = reader.row(i);
    auto model = modelOf(row, reader, where);
    if (i > 0 && (row.tau != penalty.tau || row.floor != penalty.floor))
      reader.refuse(where + ": tau or floor differ from the entry before");
    penalty = {row.tau, row.floor};
    if (row.member == 0) {
      models.push_back(std::move(model));
      continue;
    }
    if (models.empty() || row.member != models.back().members.size() ||
        !sameModel(models.back(), model))
      reader.refuse(where + ": it is no further member of the model before it");
    models.back().members.push_back(std::move(model.members.front()));
  }
  return models;
}

pcl::PCLPointCloud2
readTable(const std::string& path)
{
  SourcePoints content;
  if (const auto problem = detail::readPcd(path, content); !problem.empty())
    throw DatabaseFileError("cannot read the database '" + path + "': " + problem);
  return std::move(content.cloud);
}

} // namespace

void
saveDatabase(const ModelDatabase& database, const std::string& path)
{
  if (database.empty())
    throw DatabaseFileError("cannot write the database '" + path + "': it has no models");
  SourcePoints content;
  auto& table = content.cloud;
  table = emptyTable(static_cast<std::uint32_t>(database.resolution().bins()));
  for (std::size_t m = 0; m < database.size(); ++m)
    for (std::size_t k = 0; k < database[m].members.size(); ++k) {
      Row row = rowOf(database[m], k, database.getPenalty());
      appendRow(row, table);
    }
  table.row_step = table.point_step * table.width;
  if (const auto problem = detail::replaceFile(path, detail::binaryPcd(content)); !problem.empty())
    throw DatabaseFileError("cannot write the database '" + path + "': " + problem);
}

ModelDatabase
loadDatabase(const std::string& path)
{
  const auto table = readTable(path);
  const TableReader reader(path, table);
  ModelDatabase database;
  PenaltyParameters penalty;
  try {
    for (auto& model : modelsOf(reader, std::size_t{table.width} * table.height, penalty))
      database.add(std::move(model));
    database.setPenalty(penalty);
  }
  catch (const DatabaseError& error) {
    reader.refuse(std::string(error.what()) + "; train it again");
  }
  if (database.empty())
    reader.refuse("it has no models");
  return database;
}

} // namespace pcl_surflet
