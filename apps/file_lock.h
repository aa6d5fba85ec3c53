/** \file
 * One program at a time changes a file. */
#pragma once

#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Waits until no other program holds \p path, then holds it until this one ends.
 *
 * Who reads a file, changes what is in it and replaces it loses what another program put there in
 * between. The lock is an flock() of PATH.lock, so it ends with the program, however that ends; the
 * side file is removed at a normal end and is harmless otherwise. Does nothing where no such file
 * can be made or locked (read-only directories, some network file systems): writing will say why.
 */
void lockUntilExit(const std::string& path);

} // namespace apps
} // namespace pcl_surflet
