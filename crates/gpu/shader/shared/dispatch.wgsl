// Most workgroups of a dispatch. Loops go on by as many, of which there may be fewer: an indirect dispatch
// does not know its own number on every interface.
const MOST_WORKGROUPS: u32 = 65535u;

