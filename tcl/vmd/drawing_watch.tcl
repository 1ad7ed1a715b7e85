# drawing_watch.tcl: keeps drawings in step with VMD: shown, hidden and deleted as one, legends as wide as its window, and a
# note when their molecule shows another frame.

namespace eval ::espdiff {
    variable frame_notes [dict create]  ;# by handle: the graphics molecule of the note, molecule and frame of the surface
    variable syncing 0                  ;# we are hiding or showing molecules ourselves
    variable size_watch ""              ;# the `after` script that looks at the size of VMD's window
    variable sizes {}                   ;# of the window: the one that legends are drawn for, and the last one seen

    # Called when drawings have come or gone.
    proc watch_drawings {} {
        variable drawings
        foreach {name action} {::vmd_frame ::espdiff::on_vmd_frame ::vmd_logfile ::espdiff::on_drawing_command} {
            trace remove variable $name write $action
            if {[dict size $drawings] > 0} { trace add variable $name write $action }
        }
        watch_save_state
        if {[dict size $drawings] > 0} {
            variable sizes
            set sizes [list [display get size] [display get size]]
            watch_size
        }
    }

    # VMD tells nobody that its window was resized. Legends follow once the size stays.
    proc watch_size {} {
        variable drawings
        variable size_watch
        variable sizes
        after cancel $size_watch
        if {[dict size $drawings] == 0} return
        lassign $sizes fitted last
        set now [display get size]
        set sizes [list $fitted $now]
        if {$now ne $fitted && $now eq $last && [catch { fit_drawings } message]} { say $message }
        set size_watch [after 400 ::espdiff::watch_size]
    }

    # Draws for the current size of the window: a linked view as a whole, otherwise the legends.
    proc fit_drawings {} {
        variable linked
        variable drawn_options
        variable drawn_plans
        variable sizes
        set sizes [list [display get size] [display get size]]
        if {$linked ne ""} {
            set handle [dict get $linked handle]
            draw_linked [dict get $drawn_options $handle] $handle
        }
        dict for {handle plan} $drawn_plans { replace_legend $handle $plan }
        place_legends
    }

    # `mol on N`, `mol off N` and `mol delete N`, by which VMD logs what its own window does too.
    proc on_drawing_command {args} {
        variable syncing
        if {$syncing} return
        # An error here would make the user's command fail.
        catch {
            if {[regexp {^mol (on|off) (\d+)} $::vmd_logfile -> action mol]} { show_together $action $mol }
            if {[string match "mol delete*" $::vmd_logfile]} { after idle [list ::espdiff::notice_deleted] }
        }
    }

    proc show_together {action mol} {
        variable drawings
        variable linked
        variable syncing
        dict for {handle molecules} $drawings {
            # In a linked view the panels are shown one by one.
            if {$mol ni $molecules || ($linked ne "" && [dict get $linked handle] eq $handle)} continue
            set syncing 1
            finally {
                foreach part $molecules { if {$part in [molinfo list] && $part != $mol} { mol $action $part } }
            } { set syncing 0 }
            update_frame_note $handle
        }
    }

    # A drawing of which the user deleted a part goes as a whole.
    proc notice_deleted {} {
        variable drawings
        set now [molinfo list]
        dict for {handle molecules} $drawings {
            foreach mol $molecules {
                if {$mol in $now} continue
                forget_drawing $handle
                break
            }
        }
    }

    # A note of the frame of the surface, shown while its molecule shows another one. It is made now, hidden: VMD must
    # not get new molecules while it changes a frame.
    proc add_frame_note {handle side} {
        variable jobs
        variable frame_notes
        forget_frame_note $handle
        set mol [molecule_of $handle $side]
        if {$mol eq "" || ![dict exists $jobs $handle ${side}_frame] || [molinfo $mol get numframes] < 2} return
        set frame [dict get $jobs $handle ${side}_frame]
        keep_view {
            set note [new_legend $handle [graphics_name $handle note] 0]
            graphics $note color [legend_text_color]
            draw_text $note "Surface: frame $frame of [molinfo $mol get name]; its atoms show another frame" 0 0.82 0.8
            build_list $note
            mol off $note
        }
        dict set frame_notes $handle [list $note $mol $frame]
        place_legends
        update_frame_note $handle
    }

    proc update_frame_note {handle} {
        variable frame_notes
        variable drawings
        variable syncing
        if {![dict exists $frame_notes $handle]} return
        lassign [dict get $frame_notes $handle] note mol frame
        set now [molinfo list]
        if {$note ni $now || $mol ni $now} return
        set surface [lindex [drawing_of $handle] 0]
        set wanted [expr {[molinfo $mol get frame] != $frame && $surface in $now && [molinfo $surface get displayed]}]
        if {$wanted == [molinfo $note get displayed]} return
        set before $syncing
        set syncing 1
        finally { mol [expr {$wanted ? "on" : "off"}] $note } { set syncing $before }
    }

    proc on_vmd_frame {args} {
        variable frame_notes
        # An error here would make the user's command fail.
        catch { foreach handle [dict keys $frame_notes] { update_frame_note $handle } }
    }

    proc forget_frame_note {handle} {
        variable frame_notes
        if {![dict exists $frame_notes $handle]} return
        set note [lindex [dict get $frame_notes $handle] 0]
        dict unset frame_notes $handle
        keep_view { delete_molecules [list $note] }
        place_legends
    }
}
