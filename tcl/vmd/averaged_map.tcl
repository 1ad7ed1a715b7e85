# averaged_map.tcl: the mean of PME over the frames around one frame of a trajectory: `-map {pme average N}`.

# Explicit water next to the surface makes the potential of single frames differ by up to hundreds of kT/e. The mean over a
# window of frames is that of the solvent. The other frames are superposed on the window's own frame.
namespace eval ::espdiff {
    # The frames in the mean; 1 for no mean.
    proc frames_in_mean {map} {
        if {![is_computed $map] || [llength $map] % 2 == 0} { return 1 }
        return [value_or [lrange $map 1 end] average 1]
    }

    # Refuses what cannot be averaged before the run begins.
    proc check_average {map mol n_frames settings} {
        set n [frames_in_mean $map]
        if {$n eq "1"} return
        if {![string is integer -strict $n] || $n < 1} { fail "-map: average '$n' is not a number of frames from 1" }
        if {[lindex $map 0] ne "pme"} {
            fail "-map: [lindex $map 0] has a continuum in the place of water, so that there is nothing to average; take pme"
        }
        if {$mol eq ""} { fail "-map: an average over frames needs -mol; of files the command line's `espdiff potential`" }
        if {$n > $n_frames} { fail "-map: an average over $n frames, and the molecule has $n_frames" }
        if {[value_or $settings causes ""] ne ""} {
            fail "-map: an average over frames does not tell which charges make it; leave out -causes, or the average"
        }
    }

    # The core's map of a frame: the mean over n frames around it, fewer on one side at the trajectory's ends.
    proc averaged_map {mol map frame role} {
        variable default_device
        set keys [lrange $map 1 end]
        set n [dict get $keys average]
        set sel [value_or $keys sel all]
        set settings [dict remove $keys average sel cell]
        set align [expr {[has_atoms $mol backbone] ? "backbone" : "all"}]
        set charges [vmd_charges $mol $sel $frame $role]
        set options [dict create sel $sel align $align]
        set core [dict merge [list method pme align $align around 1 device $default_device] $settings]
        if {[dict exists $keys cell]} { dict set core cell [dict get $keys cell] }
        set handle [core::potential $core]
        finally {
            foreach one [window_around $frame $n [molinfo $mol get numframes]] {
                core::potential_frame $handle [potential_frame $mol $one $charges $options]
                potential_wait $handle "" 0 $n
            }
            set volume [core::potential_put $handle mean]
        } { core::delete $handle }
        return [dict merge $settings [list memory $volume name "[molinfo $mol get name], frame $frame" mean_over $n \
            charges $charges water [vmd_has_water $mol $charges]]]
    }

    # The frame itself first: the others are superposed on it.
    proc window_around {frame n n_frames} {
        set first [expr {max(0, min($frame - ($n - 1) / 2, $n_frames - $n))}]
        set frames $frame
        for {set i $first} {$i < $first + $n} {incr i} { if {$i != $frame} { lappend frames $i } }
        return $frames
    }

    proc has_atoms {mol text} {
        set selection [atomselect $mol $text]
        finally { expr {[$selection num] > 0} } { $selection delete }
    }
}
