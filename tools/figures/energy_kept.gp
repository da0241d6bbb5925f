# Draws what tools/figures/energy_kept has run: runs is the folder, out the file.
if (out[strlen(out)-3:*] eq '.pdf') {
  set terminal pdfcairo size 10.83in,3.65in font 'sans-serif,10.5'  # the same in inches and points
} else {
  set terminal svg size 1040,350 font 'sans-serif,14' background rgb 'white'
}
set output out
set datafile separator ','
set border linewidth 0.6 linecolor rgb '#333333'
file(name) = runs.'/'.name.'.run/trajectory.csv'
red = '#d55e00'
green = '#009e73'
blue = '#0072b2'
starts = '0 62750 125500 188250 250975'
reds = '#f8d0a8 #f0a35e #e8863a #d55e00 #8a2f00'

set multiplot
set tmargin at screen 0.88
set bmargin at screen 0.155
set xrange [-3.35:1.75]
set yrange [-2.15:2.15]
set size ratio -1
unset tics
unset border
set key off
within(t, i) = t >= word(starts, i) && t <= word(starts, i) + 25.2
set label 10 'period 1' at -2.45,1.55 right textcolor rgb '#c08040' font ',12'
set label 11 'period 10 000' at -0.75,-0.75 center textcolor rgb '#8a2f00' font ',12'
set object 1 circle at 0,0 size 0.05 fillcolor rgb 'black' fillstyle solid noborder
set lmargin at screen 0.005
set rmargin at screen 0.28
set title 'rk4: the orbit shrinks and turns' textcolor rgb red offset 0,-0.6
plot for [i = 1:5] file('rk4') using 3:(within($2, i) ? $4 : NaN) with lines linewidth 1.6 linecolor rgb word(reds, i)
unset label 10
unset label 11
set lmargin at screen 0.285
set rmargin at screen 0.56
set title 'kahan-li8: the same ellipse' textcolor rgb green offset 0,-0.6
plot for [i = 1:5] file('kahan-li8') using 3:(within($2, i) ? $4 : NaN) with lines linewidth 1.6 linecolor rgb green
unset object 1
set border 3
set size noratio
set lmargin at screen 0.63
set rmargin at screen 0.92
set title 'largest energy error so far, |H - H_0|' textcolor rgb 'black' offset 0,-0.6
set logscale xy
set format '10^{%L}'
set xrange [1:1e4]
set yrange [1e-16:1]
set xtics 10 nomirror scale 0.6
set ytics 1e-16,1e4,1 nomirror scale 0.6
set mxtics 1
set mytics 1
set xlabel 'periods' offset 0,0.4
set label 1 'rk4' at 1.2e4,0.08 textcolor rgb red
set label 2 'kahan-li8' at 1.2e4,1.3e-11 textcolor rgb green
set label 3 'cg' at 1.2e4,4e-15 textcolor rgb blue
largest = 0
so_far(x) = (largest = abs(x + 0.25) > largest ? abs(x + 0.25) : largest)
period = 25.1327412287183
plot largest = 0, file('rk4') using ($2/period):(so_far($7)) with lines linewidth 2 linecolor rgb red, \
     largest = 0, file('kahan-li8') using ($2/period):(so_far($7)) with lines linewidth 2 linecolor rgb green, \
     largest = 0, file('cg') using ($2/period):(so_far($7)) with lines linewidth 2 linecolor rgb blue
unset multiplot
