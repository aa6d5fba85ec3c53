#include "sensor_options.h"

#include "scene_items.h"

namespace pcl_surflet {
namespace apps {
namespace {

void
addViews(CommandLine& line, ViewOptions& v)
{
  addChoice<ViewSet>(line, "-views",
                     "what a virtual depth camera sees from there, in place of complete surfaces "
                     "(ring24 every 30 degrees by two cameras, pass along x and back on the other "
                     "side)",
                     v.views,
                     {{"one", ViewSet::One},
                      {"two", ViewSet::Two},
                      {"ring24", ViewSet::Ring24},
                      {"all24", ViewSet::All24},
                      {"pass", ViewSet::Pass}});
  line.real("-path", "L", "pass: length of the way, default 2", v.path, 0, 1e6);
  line.option("-stops", "N", "pass: views in all, default 24",
              [&v](const std::string& text) { v.stops = parseCount("-stops", text, 2, 10000); });
}

void
addPlaces(CommandLine& line, ViewOptions& v)
{
  line.real("-distance", "D", "of the sensors from the middle of the scene, default 1.4",
            v.distance, 1e-6, 1e6);
  line.real("-elevation", "A", "of the sensors above the horizon, degrees, default 45", v.elevation,
            -89, 89);
  line.real("-elevation2", "A", "of the ring's second camera, default 25", v.second_elevation, -89,
            89);
  line.real("-azimuth", "A", "of the first sensor about the vertical, degrees, default 0",
            v.azimuth, -360, 360);
}

} // namespace

void
addSensor(CommandLine& line, SceneSensing& o)
{
  addViews(line, o.views);
  addPassingSensor(line, o);
}

void
addPassingSensor(CommandLine& line, SceneSensing& o)
{
  DepthSensor& s = o.sensor;
  addPlaces(line, o.views);
  line.option("-pixels", "WxH", "of the sensor, default 640x480", [&s](const std::string& text) {
    const auto size = parts(text, 'x');
    if (size.size() != 2)
      throw UsageError("option -pixels: '" + text + "' is not like 640x480");
    s.columns = parseCount("-pixels", size[0], 1, 16384);
    s.rows = parseCount("-pixels", size[1], 1, 4096);
  });
  line.real("-opening", "A", "across the picture, degrees, default 57", s.opening, 1e-3, 170);
  line.real("-sensor_noise", "S", "standard deviation of the depth at depth 1, default 0", s.noise,
            0, 1e6);
  line.real("-noise_power", "P", "by which power of the depth it grows, default 0", s.noise_power,
            0, 4);
  line.real("-quantum", "Q", "depths are multiples of it, default 0: any", s.quantum, 0, 1e6);
  line.real("-flying", "P", "share of flying points at depth edges, default 0", s.flying, 0, 1);
  line.real("-edge", "D", "depth difference of an edge, default 0.02", s.edge, 1e-9, 1e6);
  line.real("-grazing", "A", "no return beyond this angle to the normal, degrees, default 90",
            s.grazing, 1e-3, 90);
  line.real("-baseline", "B", "of a projector whose shadows are not seen, default 0: none",
            s.baseline, -1e6, 1e6);
  line.real("-normal_radius", "R", "neighbourhood of normals, default 0.007", o.normal_radius, 1e-9,
            1e6);
}

void
requireViews(const CommandLine& line)
{
  if (line.given("-views"))
    return;
  for (const char* option :
       {"-path", "-stops", "-distance", "-elevation", "-elevation2", "-azimuth", "-pixels",
        "-opening", "-sensor_noise", "-noise_power", "-quantum", "-flying", "-edge", "-grazing",
        "-baseline", "-normal_radius"})
    if (line.given(option))
      throw UsageError(std::string("option ") + option + ": give -views, too");
}

void
refuseNoiseOfViews(const CommandLine& line)
{
  if (line.given("-noise") && line.given("-views"))
    throw UsageError("option -noise: is for complete surfaces; with -views give -sensor_noise");
}

} // namespace apps
} // namespace pcl_surflet
