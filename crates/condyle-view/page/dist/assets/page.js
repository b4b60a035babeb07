// built by cargo xtask page
