# Run in this folder: gnuplot experiment_46.gnuplot
set terminal svg size 900,1100 background rgb 'white'
set output 'experiment_46.svg'
set datafile separator ','
set multiplot layout 4,2
set logscale z
set xlabel 'r'
set ylabel 's'
set view 60,40
set key off
set title 'list: time per search [us]'
splot 'experiment_46.csv' skip 1 using 2:1:4 with points pt 7 ps 0.4 palette
set title 'list: 100 (time/best - 1) + 1'
splot 'experiment_46.csv' skip 1 using 2:1:($5 > -99 ? $5 + 1 : 1) with points pt 7 ps 0.4 palette
set title 'octree: time per search [us]'
splot 'experiment_46.csv' skip 1 using 2:1:7 with points pt 7 ps 0.4 palette
set title 'octree: 100 (time/best - 1) + 1'
splot 'experiment_46.csv' skip 1 using 2:1:($8 > -99 ? $8 + 1 : 1) with points pt 7 ps 0.4 palette
set title 'avl: time per search [us]'
splot 'experiment_46.csv' skip 1 using 2:1:10 with points pt 7 ps 0.4 palette
set title 'avl: 100 (time/best - 1) + 1'
splot 'experiment_46.csv' skip 1 using 2:1:($11 > -99 ? $11 + 1 : 1) with points pt 7 ps 0.4 palette
set title 'linear: time per search [us]'
splot 'experiment_46.csv' skip 1 using 2:1:13 with points pt 7 ps 0.4 palette
set title 'linear: 100 (time/best - 1) + 1'
splot 'experiment_46.csv' skip 1 using 2:1:($14 > -99 ? $14 + 1 : 1) with points pt 7 ps 0.4 palette
unset multiplot
