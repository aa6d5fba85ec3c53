#!/bin/sh
# An app of the moved installation finds its library: program $1.
"$1" -h | grep -q "Usage\|usage\|pcl_surflet"
