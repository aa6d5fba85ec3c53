# Run in this folder: gnuplot region_search.gnuplot
set terminal svg size 1000,800 background rgb 'white'
set output 'region_search.svg'
set datafile separator ','
set logscale xy
set format '10^{%T}'
set xlabel 'points found'
set ylabel 'ns per search'
set key top left
set multiplot layout 2,2
do for [cloud in 'cube84k cube1700k scan200k table'] {
  set title cloud
  f(kind) = sprintf("< grep '^%s:' region_search.csv | grep ',%s,' | sort -t, -k2 -g", cloud, kind)
  plot for [kind in 'linear linear_indices octree avl peer_nanoflann peer_search_kdtree peer_pcl_octree'] \
    f(kind) using 2:4 with linespoints pt 7 ps 0.4 title kind noenhanced
  unset key
}
unset multiplot
