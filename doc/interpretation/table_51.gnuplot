# Run where scenes.csv is (see scripts/evaluate_scenes.sh): gnuplot table_51.gnuplot
set terminal svg size 900,380 background rgb 'white'
set output 'table_51.svg'
set style data histogram
set style histogram clustered gap 1
set style fill solid 0.8 noborder
set yrange [0:105]
set ylabel '%'
set grid ytics
set key outside bottom center horizontal
$printed << EOD
suppressed 97.2 99.7
modelled 97.2 96.1
ignored 49.6 80.2
EOD
# Column COLUMN of METHOD, in the order of Table 5.1.
of(method, column) = sprintf("< awk -F, '$2 == \"%s\" { v[$1] = $%d } END { print \"suppressed\", v[\"excluded\"]; print \"modelled\", v[\"modelled\"]; print \"ignored\", v[\"ignored\"] }' scenes.csv", method, column)
set multiplot layout 1,2
do for [which = 1:2] {
  set title (which == 1 ? 'classification rate (5.9)' : 'accuracy (5.10)')
  at = which == 1 ? 21 : 33
  plot '$printed' using (column(which + 1)):xtic(1) title 'Table 5.1, as printed' lc rgb '#999999', \
    of('dissertation', at) using 2 title 'dissertation, reproduced' lc rgb '#1f5fa8', \
    of('explanation', at) using 2 title 'explanation' lc rgb '#c8501e', \
    of('classic_vfh', at) using 2 title 'tabletop classic (VFH)' lc rgb '#3d8c40'
}
unset multiplot
