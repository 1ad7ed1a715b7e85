# residue_map.tcl: one value of each residue along the trajectory, as a map that leads to frames and residues.

namespace eval ::espdiff::gui {
    variable residue_table {}    ;# title unit frames residues partners rows low high, as core::residue_map has them
    variable residue_stale 0     ;# the file has rows that the table lacks
    variable residue_pause_until 0
    variable residue_layout {}   ;# left, top, width, height in pixels; empty where the map is not drawn
    variable chosen_residue ""   ;# number of a row of the map; empty for none

    # The file of the shown rows' residues.
    proc residue_file_of {csv} { return "[file rootname $csv].residues.csv" }

    # Reads the table if it has grown and is wanted: for its title at first, then where it is drawn. A long table is not
    # read for every row that a run adds.
    proc update_residue_table {} {
        variable residue_table
        variable residue_stale
        variable residue_pause_until
        if {!$residue_stale || $residue_table ne "" && [clock milliseconds] < $residue_pause_until} return
        set begun [clock milliseconds]
        read_residue_table
        set ended [clock milliseconds]
        set residue_pause_until [expr {$ended + 20 * ($ended - $begun)}]
        set residue_stale [expr {$residue_table eq ""}]
    }

    proc read_residue_table {} {
        variable residue_table
        variable trajectory_run
        set residue_table {}
        if {$trajectory_run eq ""} return
        set path [residue_file_of [dict get $trajectory_run output -csv]]
        if {![file exists $path] || [file size $path] == 0} return
        set residue_table [::espdiff::core::residue_map $path]
    }

    # As the list of metrics has it; empty without a table.
    proc residue_map_title {} {
        variable residue_table
        if {$residue_table eq ""} { return "" }
        return "By residue: [string tolower [dict get $residue_table title] 0 0]"
    }

    proc shows_residue_map {} {
        variable form
        set title [residue_map_title]
        expr {$title ne "" && $form(trajectory,metric) eq $title}
    }

    proc draw_residue_map {plot} {
        variable residue_table
        variable residue_layout
        set labels [dict get $residue_table residues]
        set left [expr {[label_width $labels] + 4}]
        set residue_layout [dict create left $left top 26 width [expr {max(40, [winfo width $plot] - $left - 92)}] \
            height [expr {max(40, [winfo height $plot] - 26 - 40)}]]
        draw_residue_image $plot
        draw_residue_axes $plot
        mark_residue
    }

    # One pixel in each place of the map: a table of any size is as fast.
    proc draw_residue_image {plot} {
        variable residue_table
        variable residue_layout
        dict with residue_table {}
        dict with residue_layout {}
        set columns {}
        for {set x 0} {$x < $width} {incr x} { lappend columns [expr {$x * [llength $frames] / $width}] }
        set kind [expr {$low < 0 && $high > 0 ? "diverging" : "sequential"}]
        set none [expr {$kind eq "diverging" ? "#ffffff" : "#c8c8c8"}]
        set pixels {}
        set last -1
        for {set y 0} {$y < $height} {incr y} {
            set row [expr {$y * [llength $residues] / $height}]
            if {$row != $last} {
                set colours {}
                foreach value [lindex $rows $row] {
                    lappend colours [expr {$value eq "" ? $none
                        : [ramp_colour $kind [expr {($value - $low) / double($high - $low)}]]}]
                }
                set line {}
                foreach column $columns { lappend line [lindex $colours $column] }
                set last $row
            }
            lappend pixels $line
        }
        image create photo ::espdiff::gui::residue_image -width $width -height $height
        ::espdiff::gui::residue_image put $pixels
        $plot create image $left $top -anchor nw -image ::espdiff::gui::residue_image -tags map
    }

    proc draw_residue_axes {plot} {
        variable residue_table
        variable residue_layout
        variable plot_inks
        dict with residue_table {}
        dict with residue_layout {}
        $plot create rectangle $left $top [expr {$left + $width}] [expr {$top + $height}] \
            -outline [dict get $plot_inks axis]
        $plot create text $left [expr {$top - 7}] -anchor sw -font TkSmallCaptionFont \
            -text "$title[expr {$unit eq "" ? "" : " ($unit)"}]"
        $plot create text [expr {$left + $width / 2}] [expr {$top + $height + 22}] -anchor n -font TkSmallCaptionFont \
            -text Frame
        set line [font metrics TkSmallCaptionFont -linespace]
        set step [expr {int(ceil($line * [llength $residues] / double($height)))}]
        for {set row 0} {$row < [llength $residues]} {incr row $step} {
            $plot create text [expr {$left - 5}] [residue_y $row] -anchor e -font TkSmallCaptionFont \
                -text [lindex $residues $row]
        }
        set step [expr {int(ceil(46.0 * [llength $frames] / $width))}]
        for {set column 0} {$column < [llength $frames]} {incr column $step} {
            $plot create text [frame_x $column] [expr {$top + $height + 6}] -anchor n -font TkSmallCaptionFont \
                -text [lindex $frames $column]
        }
        set kind [expr {$low < 0 && $high > 0 ? "diverging" : "sequential"}]
        set x [expr {$left + $width + 14}]
        for {set i 0} {$i < 50} {incr i} {
            set y [expr {$top + $height * (1 - $i / 50.0)}]
            $plot create rectangle $x [expr {$y - $height / 50.0}] [expr {$x + 12}] $y -outline "" \
                -fill [ramp_colour $kind [expr {$i / 49.0}]]
        }
        $plot create rectangle $x $top [expr {$x + 12}] [expr {$top + $height}] -outline [dict get $plot_inks axis]
        foreach share {0 0.5 1} {
            $plot create text [expr {$x + 17}] [expr {$top + $height * (1 - $share) + (1 - 2 * $share) * -6}] -anchor w \
                -font TkSmallCaptionFont -text [with_unit [expr {$low + $share * ($high - $low)}]]
        }
    }

    # The middle of a frame's column, of a residue's row.
    proc frame_x {column} {
        variable residue_table
        variable residue_layout
        dict with residue_layout {
            expr {$left + $width * ($column + 0.5) / [llength [dict get $residue_table frames]]}
        }
    }
    proc residue_y {row} {
        variable residue_table
        variable residue_layout
        dict with residue_layout {
            expr {$top + $height * ($row + 0.5) / [llength [dict get $residue_table residues]]}
        }
    }

    # Row and column under the pointer; empty outside of the map.
    proc residue_cell_at {x y} {
        variable residue_table
        variable residue_layout
        if {$residue_layout eq ""} { return {} }
        dict with residue_layout {
            if {$x < $left || $x >= $left + $width || $y < $top || $y >= $top + $height} { return {} }
            list [expr {int(($y - $top) * [llength [dict get $residue_table residues]] / $height)}] \
                [expr {int(($x - $left) * [llength [dict get $residue_table frames]] / $width)}]
        }
    }

    # The position of a frame among the rows of the run; those that failed are not in the map.
    proc row_of_frame {frame} {
        variable trajectory_rows
        set i 0
        foreach row $trajectory_rows {
            if {[dict get $row frame] == $frame} { return $i }
            incr i
        }
        return ""
    }

    # "Frame 20, A:LYS 12: 1.23 kT/e"; "A:LYS 12->B:LYS 13" where its partner has another name.
    proc tell_residue_cell {row column} {
        variable widget
        variable residue_table
        dict with residue_table {}
        set value [lindex $rows $row $column]
        $widget(trajectory,point) configure -text "Frame [lindex $frames $column], [residue_of_map $row]: [expr {
            $value eq "" ? "no surface that is compared" : [with_unit $value $unit]}]"
    }

    proc residue_of_map {row} {
        lassign [residue_names $row] name partner
        return $name[expr {$partner in [list "" $name] ? "" : "\u2192$partner"}]
    }

    # In the source, and in the target; empty for no partner there.
    proc residue_names {row} {
        variable residue_table
        dict with residue_table {}
        set name [lindex $residues $row]
        list $name [expr {$partners eq "" ? $name : [lindex $partners $row]}]
    }

    # Takes VMD to the frame, and highlights the residue there.
    proc choose_residue_cell {row column} {
        variable residue_table
        variable chosen_residue
        variable chosen_point
        set chosen_residue $row
        set point [row_of_frame [lindex [dict get $residue_table frames] $column]]
        if {$point ne ""} { choose_point $point }
        mark_residue
        highlight_trajectory_residue
        tell_residue_cell $row $column
    }

    # By the arrow keys.
    proc move_residue {step} {
        variable residue_table
        variable chosen_residue
        if {![shows_residue_map]} return
        set n [llength [dict get $residue_table residues]]
        set now [expr {$chosen_residue eq "" ? -1 : $chosen_residue}]
        choose_residue_cell [expr {max(0, min($n - 1, $now + $step))}] [chosen_column]
    }

    # The map's column of the chosen point, the first one for none.
    proc chosen_column {} {
        variable residue_table
        variable chosen_point
        variable trajectory_rows
        if {$chosen_point eq ""} { return 0 }
        set frame [dict get [lindex $trajectory_rows $chosen_point] frame]
        return [expr {max(0, [lsearch -exact [dict get $residue_table frames] $frame])}]
    }

    proc mark_residue {} {
        variable widget
        variable residue_table
        variable residue_layout
        variable chosen_residue
        variable chosen_point
        variable plot_inks
        $widget(trajectory,plot) delete chosen
        if {$residue_layout eq "" || $chosen_residue eq ""
            || $chosen_residue >= [llength [dict get $residue_table residues]]} return
        dict with residue_layout {}
        set half [expr {max(3, 0.5 * $height / [llength [dict get $residue_table residues]])}]
        set y [residue_y $chosen_residue]
        $widget(trajectory,plot) create rectangle $left [expr {$y - $half}] [expr {$left + $width}] \
            [expr {$y + $half}] -outline [dict get $plot_inks chosen] -width 2 -tags chosen
        if {$chosen_point eq ""} return
        set x [frame_x [chosen_column]]
        set wide [expr {max(3, 0.5 * $width / [llength [dict get $residue_table frames]])}]
        $widget(trajectory,plot) create rectangle [expr {$x - $wide}] [expr {$y - $half - 2}] [expr {$x + $wide}] \
            [expr {$y + $half + 2}] -outline [dict get $plot_inks axis] -width 2 -tags chosen
    }

    # A dashed line at the frame that VMD shows.
    proc mark_frame_of_map {frame} {
        variable widget
        variable residue_table
        variable residue_layout
        variable plot_inks
        set column [lsearch -exact [dict get $residue_table frames] $frame]
        if {$residue_layout eq "" || $column < 0} return
        set x [frame_x $column]
        dict with residue_layout {
            $widget(trajectory,plot) create line $x $top $x [expr {$top + $height}] -dash {4 3} \
                -fill [dict get $plot_inks now] -tags now
        }
    }

    # Before another run, or rows of another file.
    proc forget_residue_map {} {
        variable residue_table {}
        variable residue_stale 1
        variable residue_layout {}
        variable chosen_residue ""
        if {[in_vmd]} { ::espdiff::forget_highlight trajectory }
    }

    # The molecule whose residues the table names: the source of each row; empty where that is a file.
    proc named_molecule {} {
        variable trajectory_run
        set reference [expr {$trajectory_run eq "" ? "" : [dict get $trajectory_run options -reference]}]
        if {[lindex $reference 0] eq "file"} { return "" }
        if {[lindex $reference 0] ne "mol"} { return [trajectory_molecule] }
        set mol [lindex $reference 1]
        expr {[in_vmd] && $mol in [molinfo list] ? $mol : ""}
    }

    # In the source, and in the molecule of the frames by its partner's name.
    proc highlight_trajectory_residue {} {
        variable form
        variable chosen_residue
        if {![in_vmd] || $chosen_residue eq ""} return
        lassign [residue_names $chosen_residue] name partner
        set residues {}
        foreach mol [list [named_molecule] [trajectory_molecule]] as [list $name $partner] {
            if {$mol ne "" && ![dict exists $residues $mol]} { lappend residues $mol $as }
        }
        ::espdiff::highlight_named trajectory $residues $form(residues,face)
    }
}
