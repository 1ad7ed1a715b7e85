# scrolled.tcl: a page that scrolls if the screen is too small.

namespace eval ::espdiff::gui {
    variable fitted  ;# by the frame of a page: width and height that the page asked for when it was fitted

    # Makes the frame `path` with a vertically scrolling page; returns the page.
    proc scrolled {path} {
        ttk::frame $path
        canvas $path.view -highlightthickness 0 -borderwidth 0 -background [ttk::style lookup TFrame -background] \
            -yscrollincrement 12 -yscrollcommand [list $path.bar set]
        ttk::scrollbar $path.bar -orient vertical -command [list $path.view yview] -takefocus 0
        grid $path.view -row 0 -column 0 -sticky news
        grid columnconfigure $path 0 -weight 1
        # The bar's place is kept while it is hidden: the page's width, and so its height, do not depend on the bar.
        grid columnconfigure $path 1 -minsize [winfo reqwidth $path.bar]
        grid rowconfigure $path 0 -weight 1
        ttk::frame $path.view.page
        $path.view create window 0 0 -anchor nw -window $path.view.page -tags page
        bind $path.view.page <Configure> [list ::espdiff::gui::fit_page $path]
        bind $path.view <Configure> [list ::espdiff::gui::fit_page $path]
        return $path.view.page
    }

    # The view is as high as the page, but asks for no more than a small screen has; the bar appears only when needed. A page
    # is at least as high as its view, so that plots grow with the window.
    proc fit_page {path} {
        variable fitted
        set width [winfo reqwidth $path.view.page]
        set height [winfo reqheight $path.view.page]
        set fitted($path) [list $width $height]
        $path.view itemconfigure page -width [expr {max($width, [winfo width $path.view])}] \
            -height [expr {max($height, [winfo height $path.view])}]
        set most [expr {min([winfo pixels $path 470p], [winfo screenheight $path] - 180)}]
        $path.view configure -width $width -height [expr {min($height, $most)}] -scrollregion [list 0 0 $width $height]
        if {[winfo height $path.view] > 1 && $height > [winfo height $path.view]} {
            grid $path.bar -row 0 -column 1 -sticky ns
        } else {
            grid remove $path.bar
        }
    }

    # A widget on a page changed its size, and perhaps what the page asks for, whose own size is set.
    proc notice_growth {path} {
        variable fitted
        set frame [page_of $path]
        if {![info exists fitted($frame)] || ![winfo exists $frame]} return
        set page $frame.view.page
        if {$fitted($frame) ne [list [winfo reqwidth $page] [winfo reqheight $page]]} { fit_page $frame }
    }

    # After a change of what the page contains: it asks for another width without an event, as its own is set.
    proc fit_page_of {path} {
        update idletasks
        fit_page [page_of $path]
        grow_in_width
    }

    # The page that contains a widget, as the frame given to `scrolled`; empty if there is none.
    proc page_of {path} {
        if {[regexp {^(.*)\.view\.page(\.|$)} $path -> frame]} { return $frame }
        return ""
    }

    # The wheel scrolls the page. It is disabled on lists and spinboxes, where it would change values unnoticed. Fields
    # reached by the Tab key are scrolled into view.
    proc keep_wheel_from_changing_values {path} {
        if {[winfo class $path] ne "Text"} { bindtags $path [concat EspdiffWheel [bindtags $path]] }
        foreach child [winfo children $path] { keep_wheel_from_changing_values $child }
        foreach {event steps} {<Button-4> -3 <Button-5> 3} {
            bind EspdiffWheel $event [list ::espdiff::gui::turn_wheel %W $steps]
            bind EspdiffWheel $event {+break}
        }
        bind EspdiffWheel <MouseWheel> {::espdiff::gui::turn_wheel %W [expr {%D > 0 ? -3 : 3}]; break}
        bind EspdiffWheel <Configure> {::espdiff::gui::notice_growth %W}
        bind EspdiffWheel <FocusIn> {::espdiff::gui::bring_into_view %W}
    }

    proc turn_wheel {path steps} {
        set page [page_of $path]
        if {$page ne "" && [winfo ismapped $page.bar]} { $page.view yview scroll $steps units }
    }

    proc bring_into_view {path} {
        set page [page_of $path]
        if {$page eq "" || $path eq "$page.view.page" || ![winfo ismapped $page.bar]} return
        set top [expr {[winfo rooty $path] - [winfo rooty $page.view]}]
        set bottom [expr {$top + [winfo height $path]}]
        if {$top < 0} { $page.view yview scroll [expr {($top - 12) / 12}] units }
        set below [expr {$bottom - [winfo height $page.view]}]
        if {$below > 0} { $page.view yview scroll [expr {($below + 23) / 12}] units }
    }
}
