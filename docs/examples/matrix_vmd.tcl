# matrix_vmd.tcl: frames of a trajectory as a matrix, by VMD's own `parallel for`.
#
#     mpirun -n 8 vmd -dispdev text -e matrix_vmd.tcl -args adk.psf adk_dims.dcd 0:10:end adk       (a VMD built with MPI)
#     vmd -dispdev text -e matrix_vmd.tcl -args adk.psf adk_dims.dcd 0:10:end adk                    (any VMD: one after another)
#
# Every rank loads the trajectory and computes parts of the matrix; the first one puts them together.
package require espdiff

# Options follow the output, each as a word of its own: VMD's start script splits words at blanks.
set options [lassign $argv structure trajectory frames out]
set mol [mol new $structure waitfor all]
mol addfile $trajectory waitfor all $mol
set variants [list [list mol $mol frames $frames sel protein map pme]]
set parts [expr {4 * [parallel nodecount]}]

proc part {number userdata} {
    global variants out parts options
    espdiff matrix $variants -output $out -shard [expr {$number + 1}]/$parts -resume 1 -threads 1 {*}$options
}

parallel for 0 [expr {$parts - 1}] part {}
parallel barrier
if {[parallel noderank] == 0} {
    set states [glob $out.shard-*-of-$parts.state]
    puts "written: [espdiff merge $states -output $out]"
    file delete {*}$states
}
quit
